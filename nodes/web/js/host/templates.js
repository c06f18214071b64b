/**
 * The pack's workflows among the host's templates: in an order, with titles, descriptions and moving thumbnails, and only
 * those whose nodes are there. By itself the host knows the names of a pack's files and nothing else.
 *
 * @typedef {object} Template
 * @property {string} name  of its file in workflows/
 * @property {string} title
 * @property {string} description
 * @property {string[]} tags  words by which it is found, too
 * @property {string[]} [needs]  types of nodes that not every host has
 */

import { TAGS } from "./template_tags.js";
import { say } from "./words.js";

const PACK = "PhysAnimator";

/** @type {Template[]} the easiest first */
export const TEMPLATES = [
  { name: "quickstart", title: say("Quickstart: hair, cape and ribbon in the wind"), description: say("The shortest way from a still picture to a video: masks of the parts, a gentle wind, frames. Start here."), tags: ["physics", "hair", "cloth", "wind"] },
  { name: "animate_illustration", title: say("Animate Illustration: one node"), description: say("Choose a picture, click on what shall move, and run: the parts are cut out, held and blown by the wind."), tags: ["physics", "hair", "cut out", "puppet"] },
  { name: "scene_editor", title: say("Scene Editor: draw wind and pins"), description: say("Draw wind, pins and paths on the picture and see it move at once."), tags: ["physics", "puppet", "pin", "wind"] },
  { name: "layers", title: say("A PSD in layers"), description: say("Hair, ribbon and skirt of a layered file move by the names of their layers, with what is drawn behind them. No masks."), tags: ["psd", "live2d", "layers"] },
  { name: "wind_and_pins", title: say("Wind and pins"), description: say("Rig points hold the hair while wind blows everywhere and one stroke runs along it, each a node."), tags: ["rig", "pin", "wind", "hair"] },
  { name: "seamless_loop", title: say("A seamless loop"), description: say("The last frame leads back to the first: for stickers, banners and live wallpapers."), tags: ["loop", "gif", "sway"] },
  { name: "contact", title: say("Parts that touch"), description: say("A flower bends into the hair and pushes the locks aside instead of passing through them."), tags: ["collision", "contact", "physics"] },
  { name: "paint_and_measure", title: say("Painted stiffness, and measures"), description: say("A mask makes the hair stiff at the head and soft at the tips; the frames are measured."), tags: ["weight paint", "stiffness", "metrics"] },
  { name: "figure_strokes", title: say("Strokes side by side"), description: say("The same hair under four strokes: two directions, two strengths."), tags: ["compare", "wind", "figure"] },
  { name: "figure_stiffness", title: say("Stiffness side by side"), description: say("The same gust on four materials, from soft to stiff."), tags: ["compare", "material", "figure"] },
  { name: "every_step", title: say("Every step, one node each"), description: say("Points, mesh, stroke, simulation, optical flow, sketches and frames, each with a preview."), tags: ["mesh", "optical flow", "sketch"] },
  { name: "render_from_animation", title: say("Frames repainted by a video model"), description: say("Stable Video Diffusion paints over the animation, held to its motion. Needs one model file, no LVCD."), tags: ["svd", "dual-clock"] },
  { name: "soft_inpaint", title: say("What is uncovered, painted by a model"), description: say("Stable Diffusion paints what the moving parts uncover. Needs an inpainting model."), tags: ["inpainting", "stable diffusion"] },
  { name: "inpaint_plate", title: say("What is uncovered, painted once"), description: say("A mask of all that the motion uncovers lets any checkpoint paint the background once; it lies still behind every frame. Needs a checkpoint."), tags: ["inpainting", "stable diffusion", "clean plate", "lama"] },
  { name: "differential_diffusion", title: say("Holes painted under a soft mask"), description: say("Differential Diffusion paints what the warped frames leave open, softly at the edges. Needs an inpainting model."), tags: ["inpainting", "stable diffusion", "differential diffusion"], needs: ["DifferentialDiffusion"] },
  { name: "see_through", title: say("One flat picture into layers (See-through)"), description: say("The See-through nodes cut a character into layers, which then move. Needs that pack and its models."), tags: ["layers", "anime", "live2d"], needs: ["SeeThrough_GenerateLayers"] },
  { name: "frame_interpolation", title: say("Twice the frames (RIFE or FILM)"), description: say("The host's own frame interpolation after the frames of the physics. Needs its model."), tags: ["interpolation", "smooth"], needs: ["FrameInterpolate"] },
  { name: "wan_vace", title: say("Wan VACE paints what is uncovered"), description: say("A warped video with holes and masks leads VACE. Needs Wan's models."), tags: ["wan", "vace", "video"], needs: ["WanVaceToVideo"] },
  { name: "wan_tracks", title: say("Wan-Move along the motion's tracks"), description: say("Points of the motion lead the video model. Needs Wan's models."), tags: ["wan", "tracks", "video"], needs: ["WanMoveTrackToVideo"] },
  { name: "wan_lines", title: say("Wan led by moving lines"), description: say("A line drawing that moves along leads the video model. Needs Wan's models."), tags: ["wan", "line art", "video"], needs: ["Wan22FunControlToVideo"] },
  { name: "wan_first_last_frame", title: say("Wan between first and last frame"), description: say("Physics draws the first frame and the last, the video model what is between. Needs Wan's models."), tags: ["wan", "keyframes", "video"], needs: ["WanFirstLastFrameToVideo"] },
  { name: "wan_time_to_move", title: say("Wan repaints the animation (Time-to-Move)"), description: say("The physics makes a crude animation, and Wan paints it anew without losing the motion. Needs ComfyUI-WanVideoWrapper and Wan's models."), tags: ["wan", "time-to-move", "ttm", "video"], needs: ["WanVideoAddTTMLatents"] },
  { name: "wan_time_to_move_core", title: say("Wan repaints the animation, without a node pack"), description: say("Time-to-Move with the host's own samplers. Needs Wan's models."), tags: ["wan", "time-to-move", "ttm", "video"], needs: ["WanImageToVideo"] },
  { name: "wan_loop", title: say("A loop by Wan"), description: say("One frame of a loop is first and last, and the frame that would come twice is left out. Needs Wan's models."), tags: ["wan", "loop", "video"], needs: ["WanFirstLastFrameToVideo"] },
  { name: "anisora_inbetweens", title: say("AniSora between keyframes"), description: say("Physics draws keyframes at chosen frames, an anime model what is between. Needs AniSora's models."), tags: ["wan", "anisora", "keyframes", "inbetween", "anime", "video"] },
  { name: "ltx_lines", title: say("LTX led by moving lines"), description: say("A line drawing that moves along leads LTX-2.3. Needs LTX's models."), tags: ["ltx", "line art", "ic-lora", "video"], needs: ["GetICLoRAParameters"] },
  { name: "ltx_tracks", title: say("LTX along the motion's tracks"), description: say("Points of the motion lead LTX-2.3. Needs the LTXVideo pack and its models."), tags: ["ltx", "tracks", "ic-lora", "video"], needs: ["GetICLoRAParameters", "LTXVDrawTracks"] },
  { name: "physanimator_paper", title: say("The paper as a graph"), description: say("Sketches bent by physics lead Stable Video Diffusion, and ToonCrafter draws between. Needs four model files."), tags: ["paper", "svd", "lvcd", "tooncrafter"] },
  { name: "paper_strict", title: say("The paper to the letter"), description: say("As the paper where public weights allow it, with Segment Anything and its own parameters. Needs model files."), tags: ["paper", "sam", "svd"] },
];

/**
 * Present the pack's templates; where a host lists templates in another way, they stay as it lists them.
 *
 * @param {any} api  the host's connection to its server
 */
export function presentTemplates(api) {
  const { getWorkflowTemplates, getCoreWorkflowTemplates } = api;
  if (typeof getWorkflowTemplates !== "function" || typeof getCoreWorkflowTemplates !== "function") return;
  const folder = folderOf(import.meta.url);
  /** @type {string[]} */
  let found = [];
  api.getWorkflowTemplates = async () => {
    const { [folder]: ours, ...others } = await getWorkflowTemplates.call(api);
    found = ours ?? [];
    return others;
  };
  api.getCoreWorkflowTemplates = async (/** @type {string | undefined} */ locale) => {
    const groups = await getCoreWorkflowTemplates.call(api, locale);
    // It may ask itself for another language.
    const others = groups.filter((/** @type {any} */ group) => group.moduleName !== folder);
    return found.length ? [...others, groupOf(folder, offered(found, registered()))] : others;
  };
}

/**
 * The templates that are there and can run, the described ones first.
 *
 * @param {string[]} found  names of the files
 * @param {Record<string, unknown> | null} types  of nodes that the host has; null where that is not known
 * @returns {Template[]}
 */
export function offered(found, types) {
  const there = TEMPLATES.filter(({ name, needs = [] }) => found.includes(name) && (!types || needs.every((type) => type in types)));
  const known = new Set(TEMPLATES.map(({ name }) => name));
  const others = found.filter((name) => !known.has(name)).sort();
  return [...there, ...others.map((name) => ({ name, title: name.replaceAll("_", " "), description: name, tags: [] }))];
}

/**
 * @param {string} folder
 * @param {Template[]} templates
 */
function groupOf(folder, templates) {
  const described = templates.map(({ needs: _, tags, ...rest }, place) => ({
    ...rest,
    tags: [PACK, ...tags.map((tag) => (TAGS.includes(tag) ? say(tag) : tag))],
    mediaType: "image",
    mediaSubtype: "webp",
    // A search sorts by use: among themselves they keep their order.
    usage: templates.length - place,
  }));
  return { moduleName: folder, title: PACK, type: "image", templates: described };
}

/** @param {string} url of a script of the pack: the host serves it from a folder with the pack's name */
export function folderOf(url) {
  return decodeURIComponent(new URL(url).pathname.split("/extensions/")[1]?.split("/")[0] ?? "");
}

function registered() {
  const types = /** @type {any} */ (globalThis).LiteGraph?.registered_node_types;
  return types && "PhysAnimator_Render" in types ? types : null;
}
