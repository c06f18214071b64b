/**
 * What can be taken hold of on the picture: the points of an item, its handles, and how it follows when they are dragged.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Point} Point
 * @typedef {import("./document.js").Reference} Reference
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 * @typedef {{id: string, at: Point, from?: Point, title: string}} Handle  from: where its line begins
 */

import { anchorOf } from "./document.js";
import { along, distance, rounded, tenth } from "./geometry.js";
import { direction } from "./items.js";
import { shifted } from "./masks.js";

/** Length of a strength of 1 as an arrow, in longest sides of the picture. */
const STRENGTH_LENGTH = 0.03;
const DIAGONAL = Math.SQRT1_2;
/** A handle stands this far beyond zero, so that it can be told from the point it belongs to [sides]. */
const STRENGTH_FOOT = 0.015;

/** @param {SceneDocument} document */
function side(document) {
  return Math.max(document.width, document.height);
}

/**
 * The single points of an item by their path in it, such as "path.2".
 *
 * @param {Reference} reference
 * @param {Item} item
 * @returns {{id: string, at: Point}[]}
 */
export function verticesOf(reference, item) {
  if (reference.list === "strokes") return numbered("path", item.path ?? []);
  const corners = item.region?.type === "polygon" ? numbered("region.points", item.region.points) : [];
  if (reference.list === "query_points") return [{ id: "position", at: /** @type {Point} */ (anchorOf(item)) }];
  if (reference.list !== "rig_points") return corners;
  const keys = item.motion?.type === "path" ? numbered("motion.points", item.motion.points) : [];
  return [{ id: "position", at: item.position }, ...keys.slice(1), ...corners];
}

/**
 * @param {string} path
 * @param {Point[]} points
 */
function numbered(path, points) {
  return points.map((at, index) => ({ id: `${path}.${index}`, at }));
}

/**
 * @param {SceneDocument} document
 * @param {Reference} reference
 * @param {Item} item
 * @returns {Handle[]}
 */
export function handlesOf(document, reference, item) {
  if (reference.list === "strokes") return strokeHandles(document, item);
  return reference.list === "rig_points" ? rigHandles(item) : [];
}

/**
 * @param {SceneDocument} document
 * @param {Item} stroke
 * @returns {Handle[]}
 */
function strokeHandles(document, stroke) {
  const half = along(stroke.path, 0.5);
  const end = along(stroke.path, 1);
  const radius = stroke.radius ?? 200;
  const reach = strengthReach(document, stroke.strength ?? 2);
  return [
    {
      id: "radius",
      from: half.point,
      at: [half.point[0] - half.direction[1] * radius, half.point[1] + half.direction[0] * radius],
      title: "Radius",
    },
    {
      id: "strength",
      from: end.point,
      at: [end.point[0] + end.direction[0] * reach, end.point[1] + end.direction[1] * reach],
      title: "Strength",
    },
  ];
}

/**
 * @param {SceneDocument} document
 * @param {number} strength
 */
function strengthReach(document, strength) {
  const foot = strength < 0 ? -STRENGTH_FOOT : STRENGTH_FOOT;
  return side(document) * (foot + STRENGTH_LENGTH * strength);
}

/**
 * @param {Item} item
 * @returns {Handle[]}
 */
function rigHandles(item) {
  const [x, y] = item.position;
  const handles = [];
  const region = item.region ?? { type: "circle", radius: 20 };
  if (region.type === "circle") {
    handles.push(ring("radius", [x, y], region.radius, "Radius"));
    if (item.falloff > 0) handles.push(ring("falloff", [x, y], region.radius + item.falloff, "Falloff"));
  }
  if (item.motion?.type === "wave") {
    const [dx, dy] = unit(item.motion.direction ?? [1, 0]);
    const amplitude = item.motion.amplitude ?? 20;
    /** @type {Point} */
    const at = [x + dx * amplitude, y + dy * amplitude];
    handles.push({ id: "amplitude", from: /** @type {Point} */ ([x, y]), at, title: "Amplitude and direction" });
  }
  return handles;
}

/**
 * @param {string} id
 * @param {Point} about
 * @param {number} radius
 * @param {string} title
 * @returns {Handle}
 */
function ring(id, [x, y], radius, title) {
  return { id, at: [x + radius * DIAGONAL, y + radius * DIAGONAL], title };
}

/**
 * @param {Point} vector
 * @returns {Point}
 */
function unit([x, y]) {
  const length = Math.hypot(x, y) || 1;
  return [x / length, y / length];
}

/**
 * The item with one of its points elsewhere.
 *
 * @param {Item} item
 * @param {string} id  as verticesOf names it
 * @param {Point} to
 * @returns {Item}
 */
export function withVertex(item, id, to) {
  const keys = id.split(".");
  const index = Number(keys.at(-1));
  if (Number.isNaN(index)) return movedAnchor(item, to);
  /** @type {(holder: any, path: string[]) => any} */
  const put = (holder, path) => {
    if (path.length) return { ...holder, [path[0]]: put(holder[path[0]], path.slice(1)) };
    const points = [...holder];
    points[index] = rounded(to);
    return points;
  };
  return put(item, keys.slice(0, -1));
}

/**
 * A point at which it is held; a path begins there, and a circle lies about it.
 *
 * @param {Item} item
 * @param {Point} to
 * @returns {Item}
 */
function movedAnchor(item, to) {
  if (!item.position) return withPlace(item, to);
  const moved = { ...item, position: rounded(to) };
  if (item.motion?.type !== "path") return moved;
  const by = [to[0] - item.position[0], to[1] - item.position[1]];
  const points = item.motion.points.map((/** @type {Point} */ [x, y]) => rounded([x + by[0], y + by[1]]));
  return { ...moved, motion: { ...item.motion, points } };
}

/**
 * @param {Item} point  with x and y of its own
 * @param {Point} to
 * @returns {Item}
 */
function withPlace(point, to) {
  const [x, y] = rounded(to);
  return { ...point, x, y };
}

/**
 * The item with a handle dragged.
 *
 * @param {SceneDocument} document
 * @param {Reference} reference
 * @param {Item} item
 * @param {string} id  as handlesOf names it
 * @param {Point} to
 * @returns {Item}
 */
export function withHandle(document, reference, item, id, to) {
  if (reference.list === "strokes") return withStrokeHandle(document, item, id, to);
  const away = distance(item.position, to);
  if (id === "radius") return { ...item, region: { ...item.region, type: "circle", radius: least(away) } };
  if (id === "falloff") return { ...item, falloff: tenth(Math.max(0, away - item.region.radius)) };
  const [dx, dy] = [to[0] - item.position[0], to[1] - item.position[1]];
  const motion = away > 0 ? { amplitude: tenth(away), direction: direction(dx, dy) } : { amplitude: 0 };
  return { ...item, motion: { ...item.motion, ...motion } };
}

/**
 * @param {SceneDocument} document
 * @param {Item} stroke
 * @param {string} id
 * @param {Point} to
 */
function withStrokeHandle(document, stroke, id, to) {
  if (id === "radius") return { ...stroke, radius: least(distance(along(stroke.path, 0.5).point, to)) };
  const end = along(stroke.path, 1);
  const reach = (to[0] - end.point[0]) * end.direction[0] + (to[1] - end.point[1]) * end.direction[1];
  const beyond = Math.max(0, Math.abs(reach) / side(document) - STRENGTH_FOOT) * Math.sign(reach);
  return { ...stroke, strength: Math.round((beyond / STRENGTH_LENGTH) * 20) / 20 || 0 };
}

/** @param {number} radius */
function least(radius) {
  return Math.max(0.5, tenth(radius));
}

/**
 * The whole item elsewhere.
 *
 * @param {SceneDocument} document
 * @param {Item} item
 * @param {number} dx  [px]
 * @param {number} dy
 * @returns {Item}
 */
export function moved(document, item, dx, dy) {
  /** @type {(point: Point) => Point} */
  const shift = ([x, y]) => rounded([x + dx, y + dy]);
  const changed = { ...item };
  if (item.path) changed.path = item.path.map(shift);
  if (item.position) changed.position = shift(item.position);
  else if (anchorOf(item)) Object.assign(changed, withPlace(item, [item.x + dx, item.y + dy]));
  if (item.region?.points) changed.region = { ...item.region, points: item.region.points.map(shift) };
  if (item.region?.runs) {
    const scale = [item.region.width / document.width, item.region.height / document.height];
    changed.region = { ...item.region, ...shifted(item.region, dx * scale[0], dy * scale[1]) };
  }
  if (item.motion?.points) changed.motion = { ...item.motion, points: item.motion.points.map(shift) };
  return changed;
}
