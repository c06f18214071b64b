/** How the two nodes keep what is drawn. */

import { emptyDocument, parseDocument, serialise } from "../scene/document.js";
import { say } from "./words.js";

/**
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 */

export const SCENE = { read: parseDocument, write: serialise };

/** Query points: a scene document with nothing else in it, or one of the lists that were usual before. */
export const POINTS = {
  /**
   * @param {string} text
   * @returns {SceneDocument}
   */
  read(text) {
    const data = decoded(text);
    if (!Array.isArray(data) && (data.version || data.query_points)) return parseDocument(text);
    const points = Array.isArray(data) ? data.map((one) => pointOf(one)) : grouped(data);
    return { ...emptyDocument(1280, 720), query_points: points, sizeless: true };
  },

  /** @param {SceneDocument} document */
  write({ sizeless, ...document }) {
    if (!sizeless) return serialise(document);
    return JSON.stringify(document.query_points.map(listed));
  },
};

/** @param {string} text */
function decoded(text) {
  if (!text.trim()) return [];
  try {
    return JSON.parse(text) ?? [];
  } catch {
    throw new Error(say("These points are not JSON."));
  }
}

/** @param {any} data @returns {Item[]} */
function grouped({ positive = [], negative = [] }) {
  return [...positive.map(pointOf), ...negative.map((/** @type {any} */ one) => ({ ...pointOf(one), positive: false }))];
}

/** @param {Item} point */
function listed({ x, y, positive, part }) {
  return [x, y, positive ? 1 : 0, ...(part ? [part] : [])];
}

/** @param {any} one @returns {Item} */
function pointOf(one) {
  const [x, y, label, part] = Array.isArray(one) ? one : [one?.x, one?.y, one?.label, one?.part];
  if (!Number.isFinite(x) || !Number.isFinite(y)) throw new Error(say("These points are not understood here."));
  return { x, y, positive: !["0", 0, "negative", false].includes(label), ...(part ? { part } : {}) };
}
