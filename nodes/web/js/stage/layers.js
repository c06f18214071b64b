/**
 * The picture in layers, so that what stands still is not drawn again while something moves.
 *
 * The film below shows the moving bodies; the still layer holds the background and the items; the overlay on top holds
 * what moves or is being changed.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("./overlay.js").Picture} Picture
 * @typedef {import("./overlay.js").Placed} Placed
 */

import { allItems } from "../scene/document.js";
import { drawOverlay, drawStill } from "./overlay.js";

/** What the still layer depends on besides the items. */
const STATE = /** @type {const} */ (["view", "background", "restingMesh", "itemsShown", "selection", "cuts"]);

export class Layers {
  /** @param {import("./stage.js").Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {Picture | null} */
    this.before = null;
    /** @type {Placed[]} */
    this.still = [];
    /** @type {Placed[]} being changed at this moment, and not yet a step to undo */
    this.changing = [];
    /** Items that were drawn so far, for the tests. */
    this.drawn = 0;
  }

  /** @param {Picture} shown */
  draw(shown) {
    const lost = this.stage.sharpen();
    const others = this.#sort(shown);
    if (lost || others || STATE.some((name) => shown[name] !== this.before?.[name])) this.#drawStill(shown);
    this.before = shown;
    this.drawn += shown.itemsShown ? this.changing.length : 0;
    drawOverlay(this.stage.wiped(this.stage.overlay), shown, this.changing);
  }

  /** @param {Picture} shown */
  #drawStill(shown) {
    this.drawn += shown.itemsShown ? this.still.length : 0;
    drawStill(this.stage.wiped(this.stage.still), shown, this.still);
  }

  /**
   * Tell the items that are being changed from those that stay as they are.
   *
   * @param {Picture} shown
   * @returns {boolean} whether others stand still than before
   */
  #sort({ document, settled }) {
    if (document === this.before?.document && settled === this.before.settled) return false;
    const items = allItems(document);
    const known = document === settled ? null : new Set(allItems(settled).map(({ item }) => item));
    const still = known ? items.filter(({ item }) => known.has(item)) : items;
    this.changing = known ? items.filter(({ item }) => !known.has(item)) : [];
    const same = still.length === this.still.length && still.every((one, i) => isSame(one, this.still[i]));
    const resized = document.width !== this.before?.document.width || document.height !== this.before?.document.height;
    this.still = still;
    return resized || !same;
  }
}

/**
 * @param {Placed} one
 * @param {Placed} other
 */
function isSame(one, other) {
  return one.item === other.item && one.reference.list === other.reference.list && one.reference.index === other.reference.index;
}
