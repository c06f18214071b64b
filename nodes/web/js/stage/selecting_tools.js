/**
 * Tools that change what is there: select and drag, erase.
 *
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 */

import { allItems, itemAt, withItem, withoutItems } from "../scene/document.js";
import { distance } from "../scene/geometry.js";
import { hitTest, lineDistance } from "../scene/hit_testing.js";
import { bitmapOf, brush, measured, regionOf } from "../scene/masks.js";
import { moved, withHandle, withVertex } from "../scene/shapes.js";
import { Tool } from "./tool.js";

/** How near counts as hit, and how far the pointer must go before it drags [pixels of the screen]. */
const REACH = { mouse: 8, touch: 16 };
const DRAG = 3;

export class SelectTool extends Tool {
  /**
   * @param {import("./tool.js").Desk} desk
   * @param {string} id
   */
  constructor(desk, id) {
    super(desk, id);
    this.cursor = "default";
  }

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  down(point, event) {
    const reach = event.pointerType === "touch" ? REACH.touch : REACH.mouse;
    this.hit = hitTest(this.desk.document, point, reach * this.desk.pixel, this.desk.selection);
    this.desk.select(this.hit?.reference ?? null);
    if (!this.hit) this.desk.chooseAt(point);
    this.origin = this.hit ? this.desk.document : undefined;
    this.start = point;
    this.dragging = false;
  }

  /** @param {Point} point */
  move(point) {
    if (!this.origin || !this.hit || !this.start) return;
    this.dragging ||= distance(point, this.start) >= DRAG * this.desk.pixel;
    if (!this.dragging) return;
    const item = /** @type {Item} */ (itemAt(this.origin, this.hit.reference));
    this.desk.propose(withItem(this.origin, this.hit.reference, this.#dragged(this.origin, item, point)));
  }

  up() {
    const changed = this.dragging ? this.desk.document : null;
    const reference = this.hit?.reference ?? null;
    this.origin = undefined;
    if (changed) this.desk.commit(changed, reference);
  }

  /** @param {Point} point */
  hover(point) {
    const hit = hitTest(this.desk.document, point, REACH.mouse * this.desk.pixel, this.desk.selection);
    this.cursor = hit ? (hit.part === "body" ? "move" : "grab") : "default";
  }

  cancel() {
    if (this.origin && this.dragging) this.desk.propose(this.origin);
    this.origin = undefined;
    this.dragging = false;
    super.cancel();
  }

  /**
   * @param {SceneDocument} document
   * @param {Item} item
   * @param {Point} point
   */
  #dragged(document, item, point) {
    const { part, id, reference } = /** @type {import("../scene/hit_testing.js").Hit} */ (this.hit);
    const start = this.start ?? point;
    if (part === "handle") return withHandle(document, reference, item, id, point);
    const whole = id === "position" && (item.region?.type ?? "circle") === "circle";
    if (part === "vertex" && !whole) return withVertex(item, id, point);
    return moved(document, item, point[0] - start[0], point[1] - start[1]);
  }
}

/** Takes away whatever it passes over; of painted masks, only what lies under the brush. */
export class EraseTool extends Tool {
  /** @param {Point} point */
  down(point) {
    this.origin = this.desk.document;
    this.last = point;
    this.move(point);
  }

  /** @param {Point} point */
  move(point) {
    if (!this.origin || !this.last) return;
    const reach = REACH.mouse * this.desk.pixel;
    const { document } = this.desk;
    const gone = allItems(document).filter((one) => lineDistance(one.reference, one.item, point) <= reach);
    const rest = gone.length ? withoutItems(document, gone.map((one) => one.reference)) : document;
    const changed = this.#wiped(rest, this.last, point);
    this.last = point;
    if (changed === document) return;
    this.desk.select(null);
    this.desk.propose(changed);
  }

  up() {
    const before = this.origin;
    this.origin = undefined;
    if (before && before !== this.desk.document) this.desk.commit(this.desk.document, null);
  }

  cancel() {
    if (this.origin) this.desk.propose(this.origin);
    this.origin = undefined;
    super.cancel();
  }

  /**
   * @param {SceneDocument} document
   * @param {Point} from
   * @param {Point} to
   * @returns {SceneDocument} the same one where no mask is touched
   */
  #wiped(document, from, to) {
    let changed = document;
    const emptied = [];
    for (const { reference, item } of allItems(document)) {
      if (item.region?.type !== "mask") continue;
      const region = this.#without(document, item.region, from, to);
      if (region === item.region) continue;
      if (!measured(bitmapOf(region)).count) emptied.push(reference);
      changed = withItem(changed, reference, { ...item, region });
    }
    return emptied.length ? withoutItems(changed, emptied) : changed;
  }

  /**
   * @param {SceneDocument} document
   * @param {any} region
   * @param {Point} from
   * @param {Point} to
   */
  #without(document, region, from, to) {
    const before = bitmapOf(region);
    const bitmap = { ...before, bits: before.bits.slice() };
    const scale = [bitmap.width / document.width, bitmap.height / document.height];
    /** @type {(one: Point) => Point} */
    const inMask = ([x, y]) => [x * scale[0], y * scale[1]];
    brush(bitmap, inMask(from), inMask(to), Math.max(this.desk.brushRadius * scale[0], 0.75), 0);
    return bitmap.bits.every((bit, i) => bit === before.bits[i]) ? region : { ...region, ...regionOf(bitmap) };
  }
}
