/**
 * A document over the picture at another size: positions scale in x and y, radii and speeds with the longest side, as
 * the simulation does it.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").Point} Point
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 * @typedef {{x: number, y: number, side: number}} Scale
 */

import { rounded, tenth } from "./geometry.js";

/**
 * @param {SceneDocument} document
 * @param {number} width  [px]
 * @param {number} height
 * @returns {SceneDocument} the same one where nothing changes
 */
export function rescaled(document, width, height) {
  if (document.width === width && document.height === height) return document;
  const side = Math.max(width, height) / Math.max(document.width, document.height);
  const scale = { x: width / document.width, y: height / document.height, side };
  /** @type {SceneDocument} */
  const changed = { ...document, width, height };
  each(changed, "strokes", (stroke) => scaledStroke(stroke, scale));
  each(changed, "rig_points", (rigPoint) => scaledRigPoint(rigPoint, scale));
  each(changed, "query_points", (point) => ({ ...point, x: tenth(point.x * scale.x), y: tenth(point.y * scale.y) }));
  for (const list of ["paint", "colliders"]) {
    each(changed, list, (area) => ({ ...area, region: scaledRegion(area.region, scale) }));
  }
  if (document.wind) changed.wind = scaledWind(document.wind, scale);
  if (document.contact) changed.contact = scaledValues(document.contact, ["thickness"], side, { thickness: 1.5 });
  if (document.bodies?.some((/** @type {Item} */ body) => body.mesh)) {
    each(changed, "bodies", (body) => (body.mesh ? { ...body, mesh: scaledMesh(body.mesh, scale) } : body));
  }
  return changed;
}

/**
 * @param {SceneDocument} document  changed in place
 * @param {string} list
 * @param {(item: Item) => Item} change
 */
function each(document, list, change) {
  if (document[list]) document[list] = document[list].map(change);
}

/**
 * @param {Point} point
 * @param {Scale} scale
 * @returns {Point}
 */
function scaledPoint([x, y], scale) {
  return rounded([x * scale.x, y * scale.y]);
}

/**
 * @param {Item} wind
 * @param {Scale} scale
 * @returns {Item}
 */
function scaledWind(wind, scale) {
  const changed = scaledValues(wind, ["turbulence_size"], scale.side, { turbulence_size: 200 });
  return wind.origin ? { ...changed, origin: scaledPoint(wind.origin, scale) } : changed;
}

/**
 * @param {Item} holder
 * @param {string[]} names
 * @param {number} factor
 * @param {Record<string, number>} defaults  written out, because they are pixels of the old size
 */
function scaledValues(holder, names, factor, defaults = {}) {
  const changed = { ...holder };
  for (const name of names) {
    const value = holder[name] ?? defaults[name];
    if (value !== undefined) changed[name] = tenth(value * factor) || value * factor;
  }
  return changed;
}

/**
 * @param {Item} stroke
 * @param {Scale} scale
 */
function scaledStroke(stroke, scale) {
  const changed = scaledValues(stroke, ["radius", "speed"], scale.side, { radius: 200, speed: 600 });
  if (stroke.path) changed.path = stroke.path.map((/** @type {Point} */ point) => scaledPoint(point, scale));
  return changed;
}

/**
 * @param {Item} rigPoint
 * @param {Scale} scale
 */
function scaledRigPoint(rigPoint, scale) {
  const changed = scaledValues(rigPoint, ["falloff"], scale.side);
  changed.position = scaledPoint(rigPoint.position, scale);
  changed.region = scaledRegion(rigPoint.region ?? { type: "circle", radius: 20 }, scale);
  if (rigPoint.motion) changed.motion = scaledMotion(rigPoint.motion, scale);
  return changed;
}

/**
 * @param {Item} region
 * @param {Scale} scale
 */
function scaledRegion(region, scale) {
  if (region.type === "circle") return scaledValues(region, ["radius"], scale.side);
  if (region.type !== "polygon") return region;
  return { ...region, points: region.points.map((/** @type {Point} */ point) => scaledPoint(point, scale)) };
}

/**
 * @param {Item} motion
 * @param {Scale} scale
 * @returns {Item}
 */
function scaledMotion(motion, scale) {
  if (motion.type === "combined") {
    return { ...motion, motions: motion.motions.map((/** @type {Item} */ one) => scaledMotion(one, scale)) };
  }
  if (motion.type === "path") {
    return { ...motion, points: motion.points.map((/** @type {Point} */ point) => scaledPoint(point, scale)) };
  }
  if (motion.type !== "wave") return motion;
  const [x, y] = motion.direction ?? [1, 0];
  const length = Math.hypot(x, y) || 1;
  /** @type {Point} */
  const direction = [(x / length) * scale.x, (y / length) * scale.y];
  return { ...motion, direction, amplitude: tenth((motion.amplitude ?? 20) * Math.hypot(...direction)) };
}

/**
 * @param {Item} mesh
 * @param {Scale} scale
 */
function scaledMesh(mesh, scale) {
  const vertices = mesh.vertices.map((/** @type {Point} */ [x, y]) => [x * scale.x, y * scale.y]);
  return { ...mesh, vertices };
}
