/**
 * Pins that hold bodies where they are found to be held: in the document they are rig points like any other.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 * @typedef {import("./layers.js").Layer} Layer
 *
 * @typedef {object} Hold  as the node tells it
 * @property {number} body  its number among the bodies of the run
 * @property {string} name  empty where masks cut the bodies out
 * @property {Item[]} points  rig points without a body
 */

import { say } from "../host/words.js";
import { bodyOf, withNames, withOfBody } from "./layers.js";

/** Where a body can be held, and what that is called in a list. */
export const SIDES = {
  none: say("not held"),
  auto: say("by its shape"),
  top: say("top"),
  bottom: say("bottom"),
  left: say("left"),
  right: say("right"),
  head: say("head"),
  crown: say("forehead"),
  covered: say("behind head"),
  end: say("at its end"),
};

/**
 * @param {SceneDocument} document
 * @param {Hold} hold
 * @returns {number} of the body in the document
 */
function numberOf(document, { name, body }) {
  return name ? bodyOf(document, name) : body;
}

/**
 * The rig points that are for one body alone.
 *
 * @param {SceneDocument} document
 * @param {number} number
 * @returns {Item[]}
 */
function ownPoints(document, number) {
  return (document.rig_points ?? []).filter((/** @type {Item} */ point) => point.body === number);
}

/**
 * Whether a body is to be held where it is found to be: the document has no word of it, or says so itself.
 *
 * @param {SceneDocument} document
 * @param {Hold} hold
 */
function isUnheld(document, hold) {
  const number = numberOf(document, hold);
  const attach = document.bodies?.[number]?.attach;
  if (number >= 0 && ownPoints(document, number).length) return false;
  if (number < 0 || attach === undefined) return number < 0 || !document.rig_points;
  return attach !== "none";
}

/**
 * The document with the pins that a run has found, in front of the others: of regions that overlap, the last one leads.
 *
 * @param {SceneDocument} document
 * @param {Hold[]} holds
 * @param {Layer[]} layers  from front to back
 * @returns {SceneDocument} the same one, where none is missing
 */
export function withFoundHolds(document, holds, layers) {
  const missing = holds.filter((hold) => isUnheld(document, hold));
  return missing.length ? added(withNames(document, layers), missing) : document;
}

/**
 * The document with pins instead of those that hold the same bodies alone. What leads them about stays.
 *
 * @param {SceneDocument} document
 * @param {Hold[]} holds
 * @param {Layer[]} layers  from front to back
 */
export function withHoldsAnew(document, holds, layers) {
  const named = withNames(document, layers);
  const numbers = new Set(holds.map((hold) => numberOf(named, hold)));
  const kept = (named.rig_points ?? []).filter((/** @type {Item} */ point) => !(numbers.has(point.body) && isPin(point)));
  return added({ ...named, rig_points: kept }, holds);
}

/**
 * @param {SceneDocument} document
 * @param {Layer} layer  that moves
 * @param {string} attach  where it is to be held
 * @param {Item[] | null} points  that hold it there; null where the next run is to find them
 * @param {Layer[]} layers  from front to back
 */
export function withAttach(document, layer, attach, points, layers) {
  const named = withOfBody(withNames(document, layers), layer.name, { attach });
  return withHoldsAnew(named, [{ body: -1, name: layer.name, points: points ?? [] }], layers);
}

/**
 * The document in which a body that has lost its last rig point is held nowhere; otherwise it would be held anew.
 *
 * @param {SceneDocument} document
 * @param {SceneDocument} before
 * @returns {SceneDocument}
 */
export function withLostHolds(document, before) {
  if (document.rig_points === before.rig_points) return document;
  const lost = (document.bodies ?? []).flatMap((/** @type {Item} */ body, /** @type {number} */ number) => {
    if (!body.name || !body.attach || body.attach === "none" || ownPoints(document, number).length) return [];
    const then = bodyOf(before, body.name);
    return then >= 0 && before.bodies[then].attach === body.attach && ownPoints(before, then).length ? [body.name] : [];
  });
  return lost.reduce((/** @type {SceneDocument} */ made, /** @type {string} */ name) => withOfBody(made, name, { attach: "none" }), document);
}

/** @param {Item} point */
function isPin(point) {
  return (point.motion?.type ?? "pinned") === "pinned";
}

/**
 * @param {SceneDocument} document
 * @param {Hold[]} holds
 */
function added(document, holds) {
  const points = holds.flatMap((hold) => {
    const body = numberOf(document, hold);
    return body < 0 ? [] : hold.points.map((point) => ({ ...point, body }));
  });
  return { ...document, rig_points: [...points, ...(document.rig_points ?? [])] };
}
