/**
 * What lies under the pointer.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Point} Point
 * @typedef {import("./document.js").Reference} Reference
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 * @typedef {{reference: Reference, part: "handle" | "vertex" | "body", id: string}} Hit
 */

import { allItems, anchorOf, itemAt } from "./document.js";
import { areaOf, distance, distanceToPath, isInside } from "./geometry.js";
import { bitmapOf, measured } from "./masks.js";
import { handlesOf, verticesOf } from "./shapes.js";

/**
 * What is nearest to a point: handles and points of the selected item first, then lines and dots from the topmost
 * down, then the smallest area around it.
 *
 * @param {SceneDocument} document
 * @param {Point} point  [px]
 * @param {number} tolerance  [px]
 * @param {Reference | null} selected
 * @param {string[]} [lists]  to look in
 * @returns {Hit | null}
 */
export function hitTest(document, point, tolerance, selected, lists) {
  const item = itemAt(document, selected);
  if (selected && item) {
    const handle = nearest(handlesOf(document, selected, item), point, tolerance);
    if (handle) return { reference: selected, part: "handle", id: handle };
    const vertex = nearest(verticesOf(selected, item), point, tolerance);
    if (vertex) return { reference: selected, part: "vertex", id: vertex };
  }
  const candidates = allItems(document).filter(({ reference }) => !lists || lists.includes(reference.list));
  const line = candidates.reverse().find((one) => lineDistance(one.reference, one.item, point) <= tolerance);
  if (line) return { reference: line.reference, part: "body", id: "" };
  return smallestArea(document, candidates, point);
}

/**
 * @param {{id: string, at: Point}[]} places
 * @param {Point} point
 * @param {number} tolerance
 */
function nearest(places, point, tolerance) {
  let [found, least] = ["", tolerance];
  for (const { id, at } of places) {
    const away = distance(at, point);
    if (away <= least) [found, least] = [id, away];
  }
  return found;
}

/**
 * How far the lines and dots of an item are.
 *
 * @param {Reference} reference
 * @param {Item} item
 * @param {Point} point
 */
export function lineDistance(reference, item, point) {
  const lines = [];
  if (item.path?.length) lines.push(distanceToPath(point, item.path));
  const anchor = anchorOf(item);
  if (anchor) lines.push(distance(point, anchor));
  if (item.motion?.type === "path") lines.push(distanceToPath(point, item.motion.points));
  if (item.region?.type === "polygon") lines.push(distanceToPath(point, item.region.points, true));
  if (item.region?.type === "circle" && reference.list === "rig_points") {
    lines.push(Math.abs(distance(point, item.position) - item.region.radius));
  }
  return Math.min(Infinity, ...lines);
}

/**
 * @param {SceneDocument} document
 * @param {{reference: Reference, item: Item}[]} candidates
 * @param {Point} point
 * @returns {Hit | null}
 */
function smallestArea(document, candidates, point) {
  let [best, least] = [/** @type {Hit | null} */ (null), Infinity];
  for (const { reference, item } of candidates) {
    const size = areaAround(document, item, point);
    if (size !== null && size < least) [best, least] = [{ reference, part: "body", id: "" }, size];
  }
  return best;
}

/**
 * The size of an item's region, where it covers the point [px^2].
 *
 * @param {SceneDocument} document
 * @param {Item} item
 * @param {Point} point
 * @returns {number | null}
 */
function areaAround(document, item, point) {
  const region = item.region;
  if (region?.type === "circle") {
    return distance(point, item.position) <= region.radius ? Math.PI * region.radius ** 2 : null;
  }
  if (region?.type === "polygon") return isInside(point, region.points) ? areaOf(region.points) : null;
  if (region?.type !== "mask") return null;
  const bitmap = bitmapOf(region);
  const column = Math.floor((point[0] / document.width) * bitmap.width);
  const row = Math.floor((point[1] / document.height) * bitmap.height);
  const within = column >= 0 && row >= 0 && column < bitmap.width && row < bitmap.height;
  if (!within || !bitmap.bits[row * bitmap.width + column]) return null;
  return (measured(bitmap).count * document.width * document.height) / bitmap.bits.length;
}
