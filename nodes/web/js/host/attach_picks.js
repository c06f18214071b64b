/**
 * What the picker of parts needs of the two nodes that have one: their picture, their values, and files that are dropped.
 *
 * @typedef {any} GraphNode  of LiteGraph
 * @typedef {import("../editor/picking.js").PickOptions} PickOptions
 */

import { linkInto } from "./links.js";
import { shownPicture } from "./shown_picture.js";
import { choose, upload, uploadOf, warn } from "./upload.js";
import { EXAMPLE, getsPicture, pathOfFile, upstreamPicture } from "./upstream.js";
import { say, words } from "./words.js";

/** The example in the node's list of pictures, and in that of layered files; see nodes/animated_inputs.py, layer_nodes.py. */
const EXAMPLE_FILE = "PhysAnimator example.png";
const EXAMPLE_LAYERS = "PhysAnimator example.psd";
const AUTO = "auto";
/** Where the server has the picture of a layered file. */
const ARTWORK = "/physanimator/artwork?";
const LAYERED = /\.(psd|psb|ora)$/i;
const PICTURE = /\.(png|jpe?g|webp|bmp|gif|tiff?|avif)$/i;
const CLEANING = ["box", "smallest_speck", "largest_hole", "smoothing"];
const MOVE = ["preset", "wind", "wind_angle", "loop", "frames", "fps"];
const GRABCUT = "grabcut";
const [LINKED] = words("The points come from another node: run this node to see what they cut out.");

/**
 * @param {GraphNode} node
 * @param {string} name
 */
function valueOf(node, name) {
  return node.widgets?.find((/** @type {any} */ widget) => widget.name === name)?.value;
}

/**
 * @param {GraphNode} node
 * @param {string} name
 * @param {number} value
 */
function setValue(node, name, value) {
  const widget = node.widgets?.find((/** @type {any} */ one) => one.name === name);
  if (!widget) return;
  widget.value = value;
  widget.callback?.(value);
}

/**
 * @param {GraphNode} node
 * @param {string} name  of an input
 */
function isLinked(node, name) {
  const slot = (node.inputs ?? []).findIndex((/** @type {any} */ input) => input.name === name);
  return slot >= 0 && (node.isInputConnected?.(slot) ?? node.inputs[slot].link != null);
}

/**
 * The picture of Animate Illustration: from the graph where one is connected, else of its own file.
 *
 * @param {GraphNode} node
 * @param {any} rootGraph
 * @param {Record<string, any>} [outputs]  what nodes have shown, by their ids
 * @returns {string | null} its path on the server
 */
export function animatedPicture(node, rootGraph, outputs) {
  if (isLinked(node, "layers")) return loadedLayers(node) ?? node.physanimatorSeen ?? null;
  // A picture that is made by other nodes is known once the node has run.
  if (isLinked(node, "image")) return upstreamPicture(node, rootGraph) ?? node.physanimatorSeen ?? shownPicture(node, outputs);
  const file = String(valueOf(node, "picture") ?? "");
  if (file === EXAMPLE_FILE) return EXAMPLE;
  if (PICTURE.test(file.replace(/ \[\w+\]$/, ""))) return pathOfFile(file);
  return file ? ARTWORK + new URLSearchParams({ file }) : null;
}

/**
 * The layered file that a Load Layers node hands to this one.
 *
 * @param {GraphNode} node
 * @returns {string | null} its path on the server
 */
function loadedLayers(node) {
  const link = linkInto(node, (node.inputs ?? []).findIndex((/** @type {any} */ input) => input.name === "layers"));
  const loader = link && node.graph?.getNodeById(link.origin_id);
  const file = loader?.comfyClass === "PhysAnimator_LoadLayers" && loader.mode === 0 ? String(valueOf(loader, "file") ?? "") : "";
  return file && file !== EXAMPLE_LAYERS ? ARTWORK + new URLSearchParams({ file }) : null;
}

/**
 * The picture of Segment by Points: that of a file upstream, or what a preview beside it shows.
 *
 * @param {GraphNode} node
 * @param {any} rootGraph
 * @param {Record<string, any>} [outputs]
 * @returns {string | null} its path on the server
 */
export function segmentedPicture(node, rootGraph, outputs) {
  return upstreamPicture(node, rootGraph) ?? shownPicture(node, outputs);
}

/**
 * What the server calls the picture of a path.
 *
 * @param {string | null} path
 * @param {boolean} alpha  keep its transparency
 * @returns {import("../editor/picking.js").Source | null}
 */
export function sourceOf(path, alpha) {
  if (path === EXAMPLE) return { picture: null, alpha: false };
  if (path?.startsWith(ARTWORK)) return { picture: new URLSearchParams(path.slice(ARTWORK.length)).get("file"), alpha: true, layered: true };
  if (!path?.startsWith("/view?")) return null;
  const saved = new URLSearchParams(path.slice("/view?".length));
  const place = [saved.get("subfolder"), saved.get("filename")].filter(Boolean).join("/");
  const folder = saved.get("type") ?? "input";
  return { picture: folder === "input" ? place : `${place} [${folder}]`, alpha };
}

/**
 * @param {any} app
 * @param {any} api
 * @param {GraphNode} node  Animate Illustration
 * @returns {PickOptions}
 */
export function picksOfAnimation(app, api, node) {
  const root = () => app.rootGraph ?? app.graph;
  const picker = Object.assign(document.createElement("input"), { type: "file", accept: "image/*,.psd,.psb,.ora" });
  const take = (/** @type {File[]} */ files) => takeFiles(app, api, node, files);
  picker.addEventListener("change", () => {
    take([...(picker.files ?? [])]);
    picker.value = "";
  });
  node.onDragOver = (/** @type {DragEvent} */ event) => !!event.dataTransfer?.types?.includes("Files");
  node.onDragDrop = (/** @type {DragEvent} */ event) => {
    const files = [...(event.dataTransfer?.files ?? [])];
    if (!files.some((file) => LAYERED.test(file.name) || PICTURE.test(file.name))) return false;
    take(files);
    return true;
  };
  const values = node.widgets?.find((/** @type {any} */ widget) => widget.name === "preset")?.options?.values;
  return {
    source: () => {
      // Where a scene is connected, nothing is cut; nor are layers that only a run makes.
      if (isLinked(node, "scene") || isLinked(node, "points") || (isLinked(node, "layers") && !loadedLayers(node))) return null;
      return sourceOf(animatedPicture(node, root(), app.nodeOutputs), !isLinked(node, "image") || isLinked(node, "image_alpha"));
    },
    cleaning: () => ({}),
    move: () => Object.fromEntries(MOVE.map((name) => [name, valueOf(node, name)])),
    url: (path) => api.apiURL(path),
    presets: (Array.isArray(values) ? values : []).filter((name) => name !== AUTO),
    choosePicture: () => picker.click(),
    takePicture: (file) => take([file]),
    setLength: (frames) => setValue(node, "frames", frames),
    hint: (picture, named) => hintOf(node, picture, named),
  };
}

/**
 * @param {GraphNode} node
 * @param {boolean} picture  whether there is one to be seen
 * @param {number | null} named  how many layers move by their names; null where that is not known
 */
function hintOf(node, picture, named) {
  if (isLinked(node, "scene")) return say("The scene that is connected says what acts: run this node to see it move.");
  const file = String(valueOf(node, "picture") ?? "");
  const layered = isLinked(node, "layers") || (!isLinked(node, "image") && file !== EXAMPLE_FILE && !PICTURE.test(file));
  if (isLinked(node, "points")) return say(LINKED);
  if (layered) return hintOfLayers(picture, named);
  if (picture && isLinked(node, "masks")) return say("Click on what else shall move, or run this node: the masks that are connected move.");
  if (picture) return say("Click on what shall move.");
  if (isLinked(node, "image")) return say("Run this node once to see its picture here, then click on what shall move.");
  return say("Drop a picture here, or choose one.");
}

/**
 * @param {boolean} picture  whether it is to be seen
 * @param {number | null} named  how many layers move by their names; null where that is not known
 */
function hintOfLayers(picture, named) {
  if (!picture) return say("Run this node once to see its picture here, then click on what shall move.");
  if (named === null) return say("Click on what shall move, besides the layers whose names say so; then run this node.");
  if (!named) return say("No layer moves by its name: click on what shall move.");
  return say("Layers move by their names. Click on what else shall move, or with Alt on what shall stand still.");
}

/**
 * @param {any} app
 * @param {any} api
 * @param {GraphNode} node
 * @param {File[]} files
 */
async function takeFiles(app, api, node, files) {
  const title = say("Animate Illustration");
  const layered = uploadOf(files, "")?.files[0];
  const file = layered && LAYERED.test(layered.name) ? layered : files.find((one) => PICTURE.test(one.name));
  if (!file) return warn(app, say("Choose a picture, or a .psd, .psb or .ora file."), title);
  try {
    const stored = await upload(api, file, "");
    choose(app, node, "picture", stored);
    const editor = node.physanimatorEditor;
    editor.picking.anew();
    if (isLinked(node, "image") || isLinked(node, "layers")) warn(app, say("The picture that is connected stands above the file: disconnect it to use the file."), title);
    editor.look?.();
  } catch (error) {
    warn(app, say("The file could not be uploaded: {reason}", { reason: error instanceof Error ? error.message : String(error) }), title);
  }
}

/**
 * How the picture gets into a node that has none of its own, and what to do once it is on its way.
 *
 * @param {GraphNode} node
 * @param {any} rootGraph
 * @param {boolean} picture  whether it is to be seen
 * @param {Record<string, any>} outputs  what nodes have shown, by their ids
 */
function hintOfPicture(node, rootGraph, picture, outputs) {
  if (picture || segmentedPicture(node, rootGraph, outputs)) return say("Click on what shall move.");
  if (getsPicture(node, rootGraph)) return say("The picture appears here once a node has shown it: connect a Preview Image beside this node, run that, then click on what shall move.");
  if (node.graph && node.graph !== rootGraph) return say("Connect a picture, such as that of Load Image, to the node of this subgraph: it appears here, to be clicked on.");
  return say("Connect a picture, such as that of Load Image, to image: it appears here, to be clicked on.");
}

/**
 * @param {any} app
 * @param {any} api
 * @param {GraphNode} node  Segment by Points
 * @returns {PickOptions}
 */
export function picksOfSegmentation(app, api, node) {
  return {
    source: () => (isLinked(node, "points") ? null : sourceOf(segmentedPicture(node, app.rootGraph ?? app.graph, app.nodeOutputs), false)),
    cleaning: () => {
      const other = (valueOf(node, "backend") ?? GRABCUT) !== GRABCUT;
      return other ? null : Object.fromEntries(CLEANING.map((name) => [name, valueOf(node, name) ?? (name === "box" ? "" : 0)]));
    },
    move: null,
    url: (path) => api.apiURL(path),
    presets: [],
    choosePicture: null,
    takePicture: null,
    setLength: () => {},
    hint: (picture) => (isLinked(node, "points") ? say(LINKED) : hintOfPicture(node, app.rootGraph ?? app.graph, picture, app.nodeOutputs)),
  };
}
