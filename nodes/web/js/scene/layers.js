/**
 * What a scene document says of the layers of an artwork: which of them move, of what they are made, and their order.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 *
 * @typedef {object} Layer  as the node tells it
 * @property {number} index  from the back
 * @property {string} name
 * @property {boolean} shown  whether it is drawn
 * @property {boolean} moves  unless the document says otherwise
 * @property {boolean} moving  in the last run
 * @property {string} preset
 * @property {string} attach  where it is held, or would be if it moved
 * @property {string} [why]  it moves or does not
 * @property {boolean} [fixed]  whether another input of the node says so, which stands above the document
 */

import { words } from "../host/words.js";

/** Materials that a layer can be made of. */
export const PRESETS = words("hair", "ribbon", "cloth", "leaf", "jelly");

/** Lists whose entries may speak of a body by its number. */
const OF_BODIES = ["rig_points", "paint"];

/**
 * @param {SceneDocument} document
 * @param {string} name
 * @returns {number} of the body of that name, or -1
 */
export function bodyOf(document, name) {
  return (document.bodies ?? []).findIndex((/** @type {Item} */ body) => body.name === name);
}

/**
 * @param {SceneDocument} document
 * @param {Layer} layer
 */
export function movesIn(document, layer) {
  if (layer.fixed) return layer.moves;
  if (!layer.shown) return false;
  return bodyOf(document, layer.name) >= 0 || (layer.moves && !(document.still ?? []).includes(layer.name));
}

/**
 * @param {SceneDocument} document
 * @param {Layer} layer
 * @returns {string} the preset, or the name of the material
 */
export function presetIn(document, layer) {
  const material = document.bodies?.[bodyOf(document, layer.name)]?.material;
  return material?.preset ?? material?.name ?? layer.preset;
}

/**
 * @param {SceneDocument} document
 * @param {Layer} layer
 * @returns {string} where it is held
 */
export function attachIn(document, layer) {
  return document.bodies?.[bodyOf(document, layer.name)]?.attach ?? layer.attach;
}

/**
 * Whether what moves is what moved in the last run.
 *
 * @param {SceneDocument} document
 * @param {Layer[]} layers
 */
export function isAsRun(document, layers) {
  return layers.every((layer) => movesIn(document, layer) === layer.moving);
}

/**
 * The layers in the order of the document: those that it names change places among themselves.
 *
 * @param {SceneDocument} document
 * @param {Layer[]} layers  from front to back
 */
export function inOrder(document, layers) {
  const named = new Map(layers.map((layer) => [layer.name, layer]));
  const wanted = [...new Set([...(document.order ?? [])].reverse())].filter((name) => named.has(name));
  const among = new Set(wanted);
  let next = 0;
  return layers.map((layer) => (among.has(layer.name) ? /** @type {Layer} */ (named.get(wanted[next++])) : layer));
}

/**
 * The document in which a layer lies so many places further to the front.
 *
 * @param {SceneDocument} document
 * @param {Layer} layer
 * @param {number} places  below 0 to the back
 * @param {Layer[]} layers  all of them, from front to back
 * @returns {SceneDocument}
 */
export function withPlace(document, layer, places, layers) {
  const order = inOrder(document, layers);
  const from = order.indexOf(layer);
  const to = Math.min(Math.max(from - places, 0), order.length - 1);
  if (from === to) return document;
  order.splice(to, 0, ...order.splice(from, 1));
  return { ...document, order: order.map((one) => one.name).reverse() };
}

/**
 * The document with a named body for each layer that moves, so that it finds them again when layers come and go. Numbers
 * of bodies stay what they are.
 *
 * @param {SceneDocument} document
 * @param {Layer[]} layers  from front to back
 * @returns {SceneDocument} the same one, where nothing is to be added
 */
export function withNames(document, layers) {
  const bodies = [...(document.bodies ?? [])];
  const taken = new Set(bodies.map((body) => body.name));
  const free = layers.filter((layer) => movesIn(document, layer) && !taken.has(layer.name)).map((layer) => layer.name).reverse();
  if (!free.length) return document;
  bodies.forEach((body, number) => {
    if (!body.name && free.length) bodies[number] = { ...body, name: free.shift() };
  });
  return { ...document, bodies: [...bodies, ...free.map((name) => ({ name }))] };
}

/**
 * The document in which a layer moves, or stands still. Pins and paint of that body alone go with it.
 *
 * @param {SceneDocument} document
 * @param {Layer} layer
 * @param {boolean} moves
 * @param {Layer[]} layers  all of them, from front to back
 * @returns {SceneDocument}
 */
export function withMoves(document, layer, moves, layers) {
  if (movesIn(document, layer) === moves) return document;
  const named = withNames(document, layers);
  const still = (named.still ?? []).filter((/** @type {string} */ name) => name !== layer.name);
  if (moves) {
    const body = { name: layer.name, material: { preset: layer.preset }, attach: layer.attach };
    return withStill({ ...named, bodies: [...(named.bodies ?? []), body] }, still);
  }
  const gone = bodyOf(named, layer.name);
  return withStill(withoutBody(named, gone), layer.moves ? [...still, layer.name] : still);
}

/**
 * @param {SceneDocument} document
 * @param {Layer} layer  that moves
 * @param {string} preset
 * @param {Layer[]} layers  all of them, from front to back
 * @returns {SceneDocument}
 */
export function withPreset(document, layer, preset, layers) {
  return withOfBody(withNames(document, layers), layer.name, { material: { preset } });
}

/**
 * @param {SceneDocument} document
 * @param {string} name  of a body that it has
 * @param {Item} values
 * @returns {SceneDocument}
 */
export function withOfBody(document, name, values) {
  const bodies = [...(document.bodies ?? [])];
  const number = bodyOf(document, name);
  bodies[number] = { ...bodies[number], ...values };
  return { ...document, bodies };
}

/**
 * @param {SceneDocument} document
 * @param {number} gone  number of the body
 */
function withoutBody(document, gone) {
  /** @type {SceneDocument} */
  const changed = { ...document, bodies: document.bodies.filter((/** @type {Item} */ _, /** @type {number} */ i) => i !== gone) };
  for (const list of OF_BODIES) {
    if (!document[list]) continue;
    const kept = document[list].filter((/** @type {Item} */ item) => item.body !== gone);
    changed[list] = kept.map((/** @type {Item} */ item) => (item.body > gone ? { ...item, body: item.body - 1 } : item));
  }
  return changed;
}

/**
 * @param {SceneDocument} document
 * @param {string[]} still
 */
function withStill(document, still) {
  const { still: _, ...rest } = document;
  return still.length ? { ...rest, still } : rest;
}
