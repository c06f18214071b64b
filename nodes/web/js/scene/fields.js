/**
 * The values of an item that can be typed, with their units and bounds; they are those of the scene's JSON Schema.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Reference} Reference
 * @typedef {object} Field
 * @property {string} path  in the item
 * @property {string} title
 * @property {string} [unit]
 * @property {"number" | "integer" | "boolean" | "choice" | "pair" | "keys"} kind
 * @property {string} hint
 * @property {any} [default]
 * @property {number} [min]
 * @property {number} [max]
 * @property {number} [step]
 * @property {boolean} [optional]  whether it may be left out (an empty field)
 * @property {string[]} [choices]
 * @property {[string, string]} [columns]  titles of the two columns of keys
 * @property {[string, string]} [paths]  where keys are two lists instead of one of pairs
 * @property {string} [schema]  its place in the schema, such as "stroke.radius"
 */

import { say, words } from "../host/words.js";

const LARGEST = 1e6;

/**
 * @param {string} path
 * @param {string} title
 * @param {string} unit
 * @param {Partial<Field>} more
 * @returns {Field}
 */
function number(path, title, unit, more) {
  return { path, title, unit, kind: "number", hint: "", ...more };
}

/** @type {Field[]} */
const STROKE = [
  { path: "kind", title: say("Kind"), kind: "choice", default: "wind", choices: words("wind", "repel", "attract"), hint: say("wind blows along the path, repel pushes away, attract pulls closer."), schema: "stroke.kind" },
  number("strength", say("Strength"), say("side/s²"), { default: 2, min: -LARGEST, max: LARGEST, step: 0.1, hint: say("Acceleration at full effect. 1 is a breeze, 5 a storm. Negative turns the direction round."), schema: "stroke.strength" }),
  number("radius", say("Radius"), "px", { default: 200, min: 0.1, max: LARGEST, step: 5, hint: say("How far a particle reaches; nothing beyond is touched."), schema: "stroke.radius" }),
  number("speed", say("Speed"), "px/s", { default: 600, min: 0, max: LARGEST, step: 10, hint: say("How fast particles travel along the path. 0 is one particle at rest at the first point."), schema: "stroke.speed" }),
  number("start", say("Start"), "s", { default: 0, min: 0, max: LARGEST, step: 0.1, hint: say("When the first particle leaves."), schema: "stroke.start" }),
  number("end", say("End"), "s", { optional: true, min: 0.01, max: LARGEST, step: 0.1, hint: say("When particles stop leaving. Empty: never."), schema: "stroke.end" }),
  number("interval", say("Interval"), "s", { default: 0.5, min: 0.01, max: LARGEST, step: 0.05, hint: say("Time from one particle to the next."), schema: "stroke.interval" }),
  number("repeat", say("Repeat"), "s", { optional: true, min: 0.01, max: LARGEST, step: 0.1, hint: say("The time from start to end begins anew every so often. Empty: never."), schema: "stroke.repeat" }),
  { path: "falloff", title: say("Falloff"), kind: "choice", default: "linear", choices: words("linear", "smooth", "constant"), hint: say("How the effect falls off up to the radius."), schema: "stroke.falloff" },
  { path: "strength_keys", title: say("Strength along the path"), kind: "keys", columns: [say("part"), say("factor")], hint: say("How the strength changes along the path: part of the way from 0 to 1, and a factor there."), schema: "stroke.strength_keys" },
  { path: "speed_keys", title: say("Speed along the path"), kind: "keys", columns: [say("part"), say("factor")], hint: say("How the speed changes along the path: part of the way from 0 to 1, and a factor above 0 there."), schema: "stroke.speed_keys" },
];

const EASING = words("smooth", "linear", "ease", "hold");
const MOTIONS = words("pinned", "path", "wave", "rotation", "swing", "squash", "pulse");

/** @type {Field[]} */
const RIG_POINT = [
  { path: "motion.type", title: say("Motion"), kind: "choice", default: "pinned", choices: MOTIONS, hint: say("How the region moves: held, led along a path, swinging to and fro, turned or squashed.") },
  number("region.radius", say("Radius"), "px", { default: 20, min: 0.1, max: LARGEST, step: 1, hint: say("What is this near to the position is taken along."), schema: "circle.radius" }),
  number("falloff", say("Falloff width"), "px", { default: 0, min: 0, max: LARGEST, step: 1, hint: say("How far beyond the region its pull fades out. 0: everything outside moves freely."), schema: "rig_point.falloff" }),
  { path: "body", title: say("Body"), kind: "integer", optional: true, min: 0, max: 99, step: 1, hint: say("Number of the only body that it acts on, from 0. Empty: every body."), schema: "rig_point.body" },
];

/**
 * @param {string} type  of motion
 * @param {string} standard
 * @returns {Field}
 */
function easing(type, standard) {
  return { path: "motion.easing", title: say("Easing"), kind: "choice", default: standard, choices: EASING, hint: say("smooth flows through the keys, linear goes at even speed, ease stops at every key, hold stays and then jumps."), schema: `${type}.easing` };
}

/**
 * @param {string} type
 * @returns {Field[]} of something that comes and goes
 */
function rhythm(type) {
  return [
    number("motion.period", say("Period"), "s", { default: 2, min: 0.01, max: LARGEST, step: 0.1, hint: say("Time of one swing forth and back."), schema: `${type}.period` }),
    number("motion.phase", say("Phase"), say("degrees"), { default: 0, min: -36000, max: 36000, step: 15, hint: say("Where in its course it begins; at -90 it begins at rest."), schema: `${type}.phase` }),
  ];
}

/**
 * @param {string} type
 * @returns {Field[]} of something that is stretched
 */
function stretched(type) {
  return [
    number("motion.angle", say("Angle"), say("degrees"), { default: 90, min: -36000, max: 36000, step: 15, hint: say("Direction of the stretching: 0 along x, 90 along y."), schema: `${type}.angle` }),
    { path: "motion.keep_area", title: say("Keep area"), kind: "boolean", default: true, hint: say("Whether it narrows as much as it is stretched."), schema: `${type}.keep_area` },
  ];
}

/** @type {Record<string, Field[]>} */
const MOTION = {
  path: [
    { path: "motion.times", title: say("Times"), unit: "s", kind: "keys", columns: ["key", "s"], hint: say("When each point of the path is reached."), schema: "path.times" },
    easing("path", "smooth"),
  ],
  wave: [
    number("motion.amplitude", say("Amplitude"), "px", { default: 20, min: -LARGEST, max: LARGEST, step: 1, hint: say("How far it swings to each side."), schema: "wave.amplitude" }),
    ...rhythm("wave"),
    { path: "motion.direction", title: say("Direction"), kind: "pair", default: [1, 0], min: -LARGEST, max: LARGEST, step: 0.1, hint: say("Which way it swings first, x and y."), schema: "wave.direction" },
  ],
  swing: [
    number("motion.amplitude", say("Amplitude"), say("degrees"), { default: 10, min: -36000, max: 36000, step: 1, hint: say("How far it turns to each side, counterclockwise first."), schema: "swing.amplitude" }),
    ...rhythm("swing"),
  ],
  rotation: [
    { path: "motion.angles", title: say("Angles"), kind: "keys", columns: ["s", say("degrees")], paths: ["motion.times", "motion.angles"], hint: say("How far it is turned at each time, counterclockwise."), schema: "rotation.angles" },
    easing("rotation", "ease"),
  ],
  squash: [
    { path: "motion.factors", title: say("Factors"), kind: "keys", columns: ["s", say("factor")], paths: ["motion.times", "motion.factors"], hint: say("Length at each time; above 1 stretches, below squashes."), schema: "squash.factors" },
    ...stretched("squash"),
    easing("squash", "ease"),
  ],
  pulse: [
    number("motion.stretch", say("Stretch"), "", { default: 1.1, min: 0.05, max: 20, step: 0.05, hint: say("Largest factor; 1.2 stretches by a fifth and squashes to 1 / 1.2."), schema: "pulse.stretch" }),
    ...rhythm("pulse"),
    ...stretched("pulse"),
  ],
};

/** What a motion needs from the start, so that choosing it in the inspector gives a right document. @type {Record<string, Item>} */
const NEW_MOTION = {
  rotation: { type: "rotation", times: [0, 1], angles: [0, 20] },
  squash: { type: "squash", times: [0, 0.5, 1], factors: [1, 1.2, 1] },
};

/**
 * @param {string} path
 * @param {string} title
 * @param {string} hint
 */
function factor(path, title, hint) {
  return number(path, title, "×", { default: 1, min: 0.001, max: 1000, step: 0.25, hint, schema: `paint.${path}` });
}

/** @type {Field[]} */
const PAINT = [
  factor("stiffness", say("Stiffness"), say("Factor on the stiffness: above 1 stiffer, below 1 softer.")),
  factor("damping", say("Damping"), say("Factor on the damping: above 1 it comes to rest sooner.")),
  factor("density", say("Density"), say("Factor on the mass: above 1 heavier.")),
  { path: "body", title: say("Body"), kind: "integer", optional: true, min: 0, max: 99, step: 1, hint: say("Number of the only body that it changes, from 0. Empty: every body."), schema: "paint.body" },
];

/** @type {Field[]} */
export const SCENE_FIELDS = [
  number("frame_rate", say("Frame rate"), say("frames/s"), { default: 24, min: 1, max: 240, step: 1, hint: say("How many frames a second has. The motion stays the same."), schema: "scene.frame_rate" }),
  number("loop", say("Loop"), "s", { optional: true, min: 0.1, max: 600, step: 0.5, hint: say("Length of a seamless loop. Empty: no loop."), schema: "scene.loop" }),
  { path: "gravity", title: say("Gravity"), unit: say("side/s²"), kind: "pair", default: [0, 0], min: -LARGEST, max: LARGEST, step: 0.1, hint: say("A steady pull on everything, x and y. 0 and 0.5 pull down gently."), schema: "scene.gravity" },
  { path: "sag", title: say("Sag"), kind: "boolean", default: false, hint: say("Bodies are drawn without their weight: gravity makes them sag from the first frame on."), schema: "scene.sag" },
  { path: "strokes_as", title: say("Strokes as"), kind: "choice", default: "acceleration", choices: words("acceleration", "force", "vertex_force"), hint: say("What strengths of strokes and wind are: an acceleration; a force, which moves density 4 a quarter as far; a force on each vertex, as the paper writes."), schema: "scene.strokes_as" },
  number("time_step", say("Time step"), "s", { optional: true, min: 0.00001, max: 0.004, step: 0.0001, hint: say("Step of plain semi-implicit Euler, 0.001 in the paper; refused where it is unstable. Empty: it follows from the mesh."), schema: "scene.time_step" }),
];

/** @type {Field[]} */
export const WIND_FIELDS = [
  number("wind.strength", say("Strength"), say("side/s²"), { default: 1, min: -LARGEST, max: LARGEST, step: 0.1, hint: say("Acceleration when it blows hardest. 0.5 is a breeze, 3 a storm."), schema: "wind.strength" }),
  number("wind.angle", say("Angle"), say("degrees"), { default: 0, min: -LARGEST, max: LARGEST, step: 15, hint: say("Where it blows to: 0 to the right, 90 up, 180 to the left."), schema: "wind.angle" }),
  number("wind.gust", say("Gusts"), "", { default: 0.6, min: 0, max: 1, step: 0.1, hint: say("Share of the strength that comes and goes."), schema: "wind.gust" }),
  number("wind.gust_period", say("Gust period"), "s", { default: 2, min: 0.05, max: LARGEST, step: 0.1, hint: say("Time from gust to gust."), schema: "wind.gust_period" }),
  number("wind.turbulence", say("Turbulence"), "", { default: 0.3, min: 0, max: 1, step: 0.1, hint: say("How strong the eddies are, as a share of the wind."), schema: "wind.turbulence" }),
  number("wind.turbulence_size", say("Turbulence size"), "px", { default: 200, min: 1, max: LARGEST, step: 10, hint: say("How large an eddy is."), schema: "wind.turbulence_size" }),
];

/** @type {Field[]} */
export const CONTACT_FIELDS = [
  number("contact.friction", say("Friction"), "", { default: 0.3, min: 0, max: 1, step: 0.1, hint: say("0 slides freely, 1 hardly slides."), schema: "contact.friction" }),
  number("contact.thickness", say("Thickness"), "px", { default: 1.5, min: 0.1, max: 100, step: 0.5, hint: say("Distance that bodies keep from each other."), schema: "contact.thickness" }),
  { path: "contact.self_contact", title: say("Self-contact"), kind: "boolean", default: false, hint: say("Whether a body also keeps out of itself."), schema: "contact.self_contact" },
];

/**
 * @param {Reference} reference
 * @param {Item} item
 * @returns {Field[]}
 */
export function fieldsOf(reference, item) {
  if (reference.list === "strokes") return STROKE;
  if (reference.list === "paint") return PAINT;
  if (reference.list !== "rig_points") return [];
  const kind = item.motion?.type ?? "pinned";
  const shown = RIG_POINT.filter((field) => field.path !== "region.radius" || item.region?.type !== "polygon");
  const usable = shown.filter((field) => field.path !== "region.radius" || item.region?.type !== "mask");
  const [motion, ...rest] = usable;
  // What is combined is kept as it is: choosing one motion would lose the others.
  return kind === "combined" ? rest : [motion, ...(MOTION[kind] ?? []), ...rest];
}

/**
 * A motion of another type.
 *
 * @param {Item} item
 * @param {string} type
 * @returns {Item}
 */
export function newMotion(item, type) {
  const [x, y] = item.position;
  if (type === "path") return { type, times: [0, 1], points: [[x, y], [x + 30, y]] };
  return NEW_MOTION[type] ?? { type };
}

/** Every field there is, for the tests. */
export const ALL_FIELDS = [...STROKE, ...RIG_POINT, ...Object.values(MOTION).flat(), ...PAINT, ...SCENE_FIELDS, ...WIND_FIELDS, ...CONTACT_FIELDS];
