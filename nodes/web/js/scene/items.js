/**
 * New items as the tools make them, and what people call them.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Point} Point
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 * @typedef {import("./document.js").Reference} Reference
 */

import { say } from "../host/words.js";
import { distance, middle, rounded, tenth } from "./geometry.js";
import { bitmapOf, measured } from "./masks.js";

/** Quickest and slowest way of a region that is led by hand [s]. */
const LEAD = { least: 0.2, most: 20 };

/** @param {SceneDocument} document its longest side [px] */
export function sideOf(document) {
  return Math.max(document.width, document.height);
}

/**
 * @param {SceneDocument} document
 * @param {"wind" | "repel" | "attract"} kind
 * @param {Point[]} path
 * @param {number[]} pressures  of the pen at each point, 0 to 1; empty where it tells none
 * @returns {Item}
 */
export function newStroke(document, kind, path, pressures = []) {
  const side = sideOf(document);
  const stroke = {
    kind,
    path: path.map(rounded),
    radius: Math.round(side * (kind === "wind" ? 0.12 : 0.08)),
    speed: Math.round(side * (kind === "wind" ? 0.5 : 0.2)),
    strength: kind === "wind" ? 2 : 1.5,
    interval: kind === "wind" ? 0.75 : 1.5,
  };
  const keys = pressureKeys(path, pressures);
  return keys.length ? { ...stroke, strength_keys: keys } : stroke;
}

/**
 * Factors on the strength along a path, from the pressure of the pen: half pressed changes nothing.
 *
 * @param {Point[]} path
 * @param {number[]} pressures
 * @returns {[number, number][]}
 */
function pressureKeys(path, pressures) {
  if (pressures.length !== path.length || path.length < 2) return [];
  const lengths = [0];
  for (let i = 1; i < path.length; i++) lengths.push(lengths[i - 1] + distance(path[i - 1], path[i]));
  const total = lengths[lengths.length - 1];
  if (!(total > 0)) return [];
  const step = Math.max(1, Math.ceil(path.length / 20));
  const chosen = path.map((_, i) => i).filter((i) => i % step === 0 || i === path.length - 1);
  /** @type {[number, number][]} */
  const keys = [];
  for (const i of chosen) {
    const share = Math.round((lengths[i] / total) * 1000) / 1000;
    if (!keys.length || share > keys[keys.length - 1][0]) keys.push([share, Math.round(pressures[i] * 200) / 100]);
  }
  return keys;
}

/**
 * @param {Point} position
 * @param {Item} region
 * @param {Item} motion
 * @returns {Item}
 */
export function newRigPoint(position, region, motion = { type: "pinned" }) {
  return { position: rounded(position), region, motion };
}

/**
 * @param {SceneDocument} document
 * @returns {Item} the circle that a rig point has where none was drawn
 */
export function usualCircle(document) {
  return { type: "circle", radius: Math.round(sideOf(document) * 0.035) };
}

/**
 * A region led along a path in the time in which it was drawn.
 *
 * @param {SceneDocument} document
 * @param {Point[]} path
 * @param {number[]} times  at which each point was reached [s], rising
 * @returns {Item}
 */
export function newLead(document, path, times) {
  const taken = times[times.length - 1] - times[0];
  const stretch = Math.min(Math.max(taken, LEAD.least), LEAD.most) / (taken || 1);
  const moments = times.map((time, i) => Math.round(((time - times[0]) * stretch + i * 0.002) * 1000) / 1000);
  const motion = { type: "path", times: moments, points: path.map(rounded) };
  return newRigPoint(path[0], usualCircle(document), motion);
}

/**
 * @param {SceneDocument} document
 * @param {Point} position
 * @param {Point} target  where it swings to first
 * @returns {Item}
 */
export function newWave(document, position, target) {
  const amplitude = tenth(distance(position, target));
  const [dx, dy] = [target[0] - position[0], target[1] - position[1]];
  const motion =
    amplitude < 1
      ? { type: "wave", amplitude: Math.round(sideOf(document) * 0.02), period: 2, direction: [1, 0] }
      : { type: "wave", amplitude, period: 2, direction: direction(dx, dy) };
  return newRigPoint(position, usualCircle(document), motion);
}

/**
 * @param {number} dx
 * @param {number} dy
 * @returns {Point} of length 1, to a thousandth
 */
export function direction(dx, dy) {
  const length = Math.hypot(dx, dy) || 1;
  return [Math.round((dx / length) * 1000) / 1000, Math.round((dy / length) * 1000) / 1000];
}

/**
 * The middle of a region that is no circle [px of the picture].
 *
 * @param {SceneDocument} document
 * @param {Item} region
 * @returns {Point}
 */
export function middleOf(document, region) {
  if (region.type === "polygon") return middle(region.points);
  const { middle: painted } = measured(bitmapOf(/** @type {any} */ (region)));
  return [(painted[0] * document.width) / region.width, (painted[1] * document.height) / region.height];
}

/**
 * What people call an item.
 *
 * @param {Reference} reference
 * @param {Item} item
 */
export function titleOf(reference, item) {
  const title = kindTitle(reference.list, item);
  return `${title} ${reference.index + 1}`;
}

/** @type {Record<string, string>} */
const STROKES = { wind: say("Wind stroke"), repel: say("Repel stroke"), attract: say("Attract stroke") };
/** @type {Record<string, string>} */
const MOTIONS = {
  pinned: say("Pin"), path: say("Led point"), wave: say("Wave"), rotation: say("Rotation"), swing: say("Swing"), squash: say("Squash"), pulse: say("Pulse"),
};

/**
 * @param {string} list
 * @param {Item} item
 * @returns {string}
 */
function kindTitle(list, item) {
  if (list === "strokes") return STROKES[item.kind ?? "wind"] ?? capital(item.kind);
  if (list === "rig_points") return MOTIONS[item.motion?.type ?? "pinned"] ?? capital(item.motion.type);
  if (list === "paint") return say("Painted material");
  if (list === "query_points") return item.positive === false ? say("Point beside") : say("Point on the part");
  return say("Collider");
}

/** @param {string} text */
function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
