/** How the two nodes keep what is drawn. */

import { emptyDocument, parseDocument, serialise } from "../scene/document.js";

export const SCENE = { read: parseDocument, write: serialise };

/** Points as [[x, y, 1 or 0], ...]; such a list does not say for what size of picture. */
export const POINTS = {
  /** @param {string} text */
  read(text) {
    const document = emptyDocument(1280, 720);
    document.query_points = pointsOf(text);
    return document;
  },

  /** @param {import("../scene/document.js").SceneDocument} document */
  write(document) {
    const points = document.query_points ?? [];
    return JSON.stringify(points.map((/** @type {any} */ { position, positive }) => [...position, positive === false ? 0 : 1]));
  },
};

/**
 * @param {string} text
 * @returns {import("../scene/document.js").Item[]}
 */
function pointsOf(text) {
  if (!text.trim()) return [];
  let data;
  try {
    data = JSON.parse(text);
  } catch {
    throw new Error("These points are no JSON list; draw to replace them.");
  }
  if (Array.isArray(data)) return data.map((one) => pointOf(one));
  return [...(data.positive ?? []).map((/** @type {any} */ one) => pointOf(one)), ...(data.negative ?? []).map((/** @type {any} */ one) => ({ ...pointOf(one), positive: false }))];
}

/** @param {any} one */
function pointOf(one) {
  const [x, y, label] = Array.isArray(one) ? one : [one.x, one.y, one.label];
  if (!Number.isFinite(x) || !Number.isFinite(y)) throw new Error("These points are not understood here; draw to replace them.");
  return { position: [x, y], positive: !["0", 0, "negative", false].includes(label) };
}
