/**
 * Scene documents: reading, writing and changing them without touching what is not understood here.
 *
 * Nothing is changed in place: each change gives a new document that shares what stayed the same.
 *
 * @typedef {[number, number]} Point  x to the right, y down [px of the picture]
 * @typedef {Record<string, any>} Item  an entry of one of the lists
 * @typedef {Record<string, any>} SceneDocument
 * @typedef {{list: string, index: number}} Reference  where an item stands
 */

import { say } from "../host/words.js";

export const VERSION = 2;

/** The lists that hold items, from the lowest to the topmost on the picture. */
export const LISTS = ["paint", "colliders", "strokes", "rig_points", "query_points"];

/**
 * @param {number} width  [px]
 * @param {number} height  [px]
 * @returns {SceneDocument}
 */
export function emptyDocument(width, height) {
  return { version: VERSION, width, height };
}

/**
 * @param {string} text
 * @returns {SceneDocument}
 * @throws {Error} with a sentence for the user
 */
export function parseDocument(text) {
  let data;
  try {
    data = JSON.parse(text);
  } catch (error) {
    throw new Error(say("The scene is not valid JSON: {reason}", { reason: /** @type {Error} */ (error).message }));
  }
  if (data === null || typeof data !== "object" || Array.isArray(data)) {
    throw new Error(say("A scene must be an object in braces."));
  }
  if (!(data.version <= VERSION)) {
    throw new Error(say("This scene has version {version}; up to {newest} can be shown.", { version: data.version, newest: VERSION }));
  }
  for (const list of LISTS) {
    if (data[list] !== undefined && !Array.isArray(data[list])) throw new Error(say("{list} must be a list.", { list }));
  }
  if (!(data.width > 0 && data.height > 0)) throw new Error(say("A scene must say its width and height in pixels."));
  return data;
}

/** @param {SceneDocument} document */
export function serialise(document) {
  return JSON.stringify(document);
}

/**
 * @param {SceneDocument} document
 * @param {Reference | null} reference
 * @returns {Item | undefined}
 */
export function itemAt(document, reference) {
  return reference ? document[reference.list]?.[reference.index] : undefined;
}

/**
 * Every item with its place, from the lowest to the topmost.
 *
 * @param {SceneDocument} document
 * @returns {{reference: Reference, item: Item}[]}
 */
export function allItems(document) {
  return LISTS.flatMap((list) =>
    (document[list] ?? []).map((/** @type {Item} */ item, /** @type {number} */ index) => ({
      reference: { list, index },
      item,
    })),
  );
}

/**
 * @param {SceneDocument} document
 * @param {Reference} reference
 * @param {Item} item
 */
export function withItem(document, reference, item) {
  const entries = [...document[reference.list]];
  entries[reference.index] = item;
  return { ...document, [reference.list]: entries };
}

/**
 * @param {SceneDocument} document
 * @param {string} list
 * @param {Item} item
 * @returns {{document: SceneDocument, reference: Reference}}
 */
export function withAdded(document, list, item) {
  const entries = [...(document[list] ?? []), item];
  return { document: { ...document, [list]: entries }, reference: { list, index: entries.length - 1 } };
}

/**
 * @param {SceneDocument} document
 * @param {Reference[]} references
 */
export function withoutItems(document, references) {
  const changed = { ...document };
  for (const list of new Set(references.map((one) => one.list))) {
    const gone = new Set(references.filter((one) => one.list === list).map((one) => one.index));
    changed[list] = (document[list] ?? []).filter((/** @type {Item} */ _, /** @type {number} */ i) => !gone.has(i));
  }
  return changed;
}

/**
 * A value within nested objects, by a path such as "region.radius"; undefined where there is none.
 *
 * @param {any} holder
 * @param {string} path
 */
export function valueAt(holder, path) {
  return path.split(".").reduce((value, key) => value?.[key], holder);
}

/**
 * The holder with another value at a path; undefined removes it.
 *
 * @param {any} holder
 * @param {string} path
 * @param {any} value
 * @returns {any}
 */
export function withValue(holder, path, value) {
  const [key, ...rest] = path.split(".");
  const changed = { ...holder };
  if (rest.length) changed[key] = withValue(holder?.[key] ?? {}, rest.join("."), value);
  else if (value === undefined) delete changed[key];
  else changed[key] = value;
  return changed;
}

/**
 * Where an item is held: the position of a rig point, or a query point itself.
 *
 * @param {Item} item
 * @returns {Point | undefined}
 */
export function anchorOf(item) {
  return item.position ?? (Number.isFinite(item.x) ? [item.x, item.y] : undefined);
}

/**
 * @param {SceneDocument} document
 * @returns {Point} where something was drawn last; the upper left corner where nothing is
 */
export function workOf(document) {
  const last = allItems(document).at(-1)?.item;
  return (last && (anchorOf(last) ?? last.path?.[0])) ?? [0, 0];
}

/** @param {SceneDocument} document whether anything has been drawn */
export function hasItems(document) {
  return LISTS.some((list) => document[list]?.length);
}
