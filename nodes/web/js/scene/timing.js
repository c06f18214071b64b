/**
 * When items act [s], for the timeline.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Reference} Reference
 * @typedef {[number, number]} Span  from, to [s]
 */

import { lengthOf } from "./geometry.js";

const MOST_SPANS = 100;
/** Time between the edges of an item [s]. */
const SHORTEST = 0.05;

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

/** @typedef {"start" | "end"} Edge */

/**
 * The times at which an item begins and ceases to act, where they can be changed.
 *
 * @param {Reference} reference
 * @param {Item} item
 * @param {number} duration  of the preview [s]
 * @returns {[Edge, number][]}
 */
export function edgesOf(reference, item, duration) {
  const [from, to] = reference.list === "strokes" ? [item.start ?? 0, item.end ?? duration] : keyedTimes(reference, item);
  if (from === Infinity) return [];
  /** @type {[Edge, number][]} */
  const edges = [["start", from], ["end", Math.min(to, duration)]];
  return edges.filter(([, time]) => time <= duration);
}

/**
 * The item with one of its edges at another time. Dragged to where the preview ends, a stroke goes on without end; of a
 * motion with keys all of them spread between the edges.
 *
 * @param {Reference} reference
 * @param {Item} item
 * @param {Edge} edge
 * @param {number} time  [s]
 * @param {number} duration  [s]
 * @returns {Item}
 */
export function withEdge(reference, item, edge, time, duration) {
  const strokes = reference.list === "strokes";
  const [from, to] = strokes ? [item.start ?? 0, item.end ?? duration] : keyedTimes(reference, item);
  const there = edge === "start" ? hundredth(Math.min(Math.max(time, 0), to - SHORTEST)) : hundredth(Math.max(time, from + SHORTEST));
  if (strokes && edge === "start") return { ...item, start: Math.max(there, 0) };
  if (strokes) return time < duration ? { ...item, end: there } : withoutEnd(item);
  const [first, last] = edge === "start" ? [Math.max(there, 0), to] : [from, there];
  const times = item.motion.times.map((/** @type {number} */ one) => first + ((one - from) / (to - from)) * (last - first));
  return { ...item, motion: { ...item.motion, times: times.map((/** @type {number} */ one) => Math.round(one * 1e4) / 1e4) } };
}

/** @param {Item} stroke */
function withoutEnd({ end, ...stroke }) {
  return stroke;
}

/**
 * @param {Reference} reference
 * @param {Item} item
 * @returns {Span} of no length where no keys can be moved
 */
function keyedTimes(reference, item) {
  const times = reference.list === "rig_points" ? item.motion?.times : null;
  return times?.length > 1 ? [times[0], times.at(-1)] : [Infinity, Infinity];
}

/** @param {number} time */
function hundredth(time) {
  return Math.round(time * 100) / 100;
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
