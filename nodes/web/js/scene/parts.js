/**
 * Parts that are picked by points: each point says of which it is, and the document's bodies say what each is made of.
 *
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 */

/** @param {import("./document.js").Item} point */
export function partOf(point) {
  return point.part ?? 0;
}

/**
 * How many parts there are: those with points, and the one that is being picked.
 *
 * @param {SceneDocument} document
 * @param {number} [current]
 */
export function partCount(document, current = 0) {
  return 1 + Math.max(current, ...(document.query_points ?? []).map(partOf));
}

/**
 * @param {SceneDocument} document
 * @param {number} part
 * @returns {number} of points that are on it
 */
export function pointsOn(document, part) {
  return (document.query_points ?? []).filter((/** @type {any} */ point) => partOf(point) === part && point.positive !== false).length;
}

/**
 * @param {SceneDocument} document
 * @param {number} part
 * @returns {string} empty where nothing is said
 */
export function presetOf(document, part) {
  return document.bodies?.[part]?.material?.preset ?? "";
}

/**
 * @param {SceneDocument} document
 * @param {number} part
 * @param {string} preset  empty for what the node says
 * @returns {SceneDocument}
 */
export function withPartPreset(document, part, preset) {
  const bodies = [...(document.bodies ?? [])];
  while (bodies.length <= part) bodies.push({});
  const { material: _, ...rest } = bodies[part];
  bodies[part] = preset ? { ...rest, material: { preset } } : rest;
  // A list of points has no place for it.
  return { ...document, sizeless: undefined, bodies };
}

/**
 * The document without a part; those after it move up.
 *
 * @param {SceneDocument} document
 * @param {number} part
 * @returns {SceneDocument}
 */
export function withoutPart(document, part) {
  const kept = (document.query_points ?? []).filter((/** @type {any} */ point) => partOf(point) !== part);
  const moved = kept.map((/** @type {any} */ point) => {
    if (partOf(point) < part) return point;
    const { part: number, ...rest } = point;
    return number > 1 ? { ...rest, part: number - 1 } : rest;
  });
  const changed = { ...document, query_points: moved };
  return document.bodies ? { ...changed, bodies: document.bodies.filter((/** @type {any} */ _, /** @type {number} */ number) => number !== part) } : changed;
}
