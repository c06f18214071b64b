/**
 * Items as text, so that they can be copied from one editor into another.
 *
 * @typedef {import("../scene/document.js").Item} Item
 */

import { LISTS } from "../scene/document.js";

const NAME = "physanimator_item";

/**
 * @param {string} list
 * @param {Item} item
 */
export function copied(list, item) {
  return JSON.stringify({ [NAME]: { list, item } });
}

/**
 * @param {string | undefined} text
 * @returns {{list: string, item: Item} | null}
 */
export function pasted(text) {
  try {
    const found = JSON.parse(text ?? "")?.[NAME];
    return LISTS.includes(found?.list) && typeof found.item === "object" ? found : null;
  } catch {
    return null;
  }
}
