/**
 * When items act [s], for the timeline.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Reference} Reference
 * @typedef {[number, number]} Span  from, to [s]
 */

import { lengthOf } from "./geometry.js";

const MOST_SPANS = 100;

/**
 * The times in which an item acts.
 *
 * @param {Reference} reference
 * @param {Item} item
 * @param {number} duration  of the preview [s]
 * @returns {Span[]}
 */
export function spansOf(reference, item, duration) {
  if (reference.list === "strokes") return strokeSpans(item, duration);
  if (reference.list === "rig_points") return motionSpans(item.motion, duration);
  return reference.list === "query_points" ? [] : [[0, duration]];
}

/**
 * Times at which particles leave.
 *
 * @param {Item} stroke
 * @param {number} duration  [s]
 */
export function departures(stroke, duration) {
  const interval = Math.max(stroke.interval ?? 0.5, 0.01);
  const times = [];
  for (const [from, to] of windows(stroke, duration)) {
    for (let k = 0; from + k * interval < to - 1e-9 && times.length < 1000; k++) times.push(from + k * interval);
  }
  return times;
}

/**
 * How long a particle is under way [s], at the speed of the stroke.
 *
 * @param {Item} stroke
 */
export function lifetimeOf(stroke) {
  const length = lengthOf(stroke.path ?? []);
  const speed = stroke.speed ?? 600;
  return length > 0 && speed > 0 ? length / speed : Infinity;
}

/**
 * @param {Item} stroke
 * @param {number} duration
 * @returns {Span[]} in which particles leave
 */
function windows(stroke, duration) {
  const start = stroke.start ?? 0;
  const end = stroke.end ?? Infinity;
  /** @type {Span[]} */
  const spans = [];
  for (let k = 0; k < MOST_SPANS; k++) {
    const shift = k * (stroke.repeat ?? 0);
    if (start + shift >= duration || (k > 0 && !stroke.repeat)) break;
    spans.push([start + shift, Math.min(end + shift, duration)]);
  }
  return spans;
}

/**
 * @param {Item} stroke
 * @param {number} duration
 * @returns {Span[]}
 */
function strokeSpans(stroke, duration) {
  const lifetime = lifetimeOf(stroke);
  const interval = stroke.interval ?? 0.5;
  // Single gusts are told apart where each has left the path before the next one comes.
  if (lifetime < interval) {
    return departures(stroke, duration).map((time) => [time, Math.min(time + lifetime, duration)]);
  }
  const late = lifetime === Infinity ? 0 : lifetime;
  return windows(stroke, duration).map(([from, to]) => [from, Math.min(to + late, duration)]);
}

/**
 * @param {Item | undefined} motion
 * @param {number} duration
 * @returns {Span[]}
 */
function motionSpans(motion, duration) {
  if (motion?.type === "combined") {
    return (motion.motions ?? []).flatMap((/** @type {Item} */ one) => motionSpans(one, duration));
  }
  const times = motion?.times;
  return times?.length ? [[Math.min(times[0], duration), Math.min(times.at(-1), duration)]] : [[0, duration]];
}
