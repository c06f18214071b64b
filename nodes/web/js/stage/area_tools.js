/**
 * Tools that draw areas: polygons and brushes.
 *
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/masks.js").Bitmap} Bitmap
 */

import { say } from "../host/words.js";
import { itemAt, withAdded, withItem, withoutItems } from "../scene/document.js";
import { areaOf, distance, middle, rounded, simplified } from "../scene/geometry.js";
import { middleOf, newRigPoint } from "../scene/items.js";
import { bitmapOf, brush, emptyBitmap, measured, regionOf } from "../scene/masks.js";
import { COLOURS } from "./colours.js";
import { addRegion } from "./drawing_tools.js";
import { Tool } from "./tool.js";

const CLICK = 4;
const CLOSING = 10;
const SMOOTHING = 1.5;
/** The eraser's end of a pen, as PointerEvent.buttons tells it. */
const ERASER = 32;

/** An outline drawn in one go, or corner by corner. */
export class PolygonTool extends Tool {
  /** @param {Point} point */
  down(point) {
    const first = this.draft?.path?.[0];
    if (first && distance(point, first) < CLOSING * this.desk.pixel) {
      this.finish();
      return;
    }
    this.fresh = !this.draft;
    this.pressed = point;
    const path = [...(this.draft?.path?.slice(0, -1) ?? []), point, point];
    this.sketch({ path, closed: true, colour: COLOURS.pin });
  }

  /** @param {Point} point */
  move(point) {
    const path = this.draft?.path;
    if (!path || !this.pressed) return;
    if (this.fresh && distance(point, path[path.length - 1]) >= this.desk.pixel) path.push(point);
    this.desk.redraw();
  }

  /** @param {Point} point */
  up(point) {
    const path = this.draft?.path;
    const pressed = this.pressed;
    this.pressed = undefined;
    if (!path || !pressed || !this.fresh) return;
    if (path.every((one) => distance(one, pressed) < CLICK * this.desk.pixel)) {
      this.sketch({ path: [pressed, point], closed: true, colour: COLOURS.pin });
      this.desk.say(say("Click the next corners; click the first one again or press Enter to close."));
    } else this.#close(simplified(path, SMOOTHING * this.desk.pixel).map((i) => path[i]));
  }

  /** @param {Point} point */
  hover(point) {
    const path = this.draft?.path;
    if (!path) return;
    path[path.length - 1] = point;
    this.desk.redraw();
  }

  finish() {
    if (this.draft?.path) this.#close(this.draft.path.slice(0, -1));
  }

  /** @param {Point[]} corners */
  #close(corners) {
    this.cancel();
    if (corners.length < 3 || areaOf(corners) < 4 * this.desk.pixel ** 2) {
      this.desk.say(say("A region needs at least three corners."));
      return;
    }
    const points = corners.map(rounded);
    addRegion(this.desk, { type: "polygon", points }, middle(points));
  }
}

/** Paints a mask, or takes away from it with Alt or the pen's eraser. */
class BrushTool extends Tool {
  /** @returns {Reference | null} the item that is painted on */
  target() {
    return null;
  }

  /**
   * @param {Reference | null} target
   * @param {Bitmap} bitmap
   */
  painted(target, bitmap) {}

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  down(point, event) {
    this.on = this.target();
    const { width, height } = this.desk.document;
    const region = itemAt(this.desk.document, this.on)?.region;
    const before = region?.type === "mask" ? bitmapOf(region) : emptyBitmap(width, height);
    this.sketch({ bitmap: { ...before, bits: before.bits.slice() }, colour: this.colour() });
    this.last = point;
    this.move(point, event);
  }

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  move(point, event) {
    const bitmap = this.draft?.bitmap;
    if (!bitmap || !this.last) return;
    const { width, height } = this.desk.document;
    const scale = [bitmap.width / width, bitmap.height / height];
    const away = event.altKey || (event.buttons & ERASER) !== 0;
    /** @type {(one: Point) => Point} */
    const inMask = ([x, y]) => [x * scale[0], y * scale[1]];
    brush(bitmap, inMask(this.last), inMask(point), Math.max(this.desk.brushRadius * scale[0], 0.75), away ? 0 : 1);
    this.last = point;
    this.desk.redraw();
  }

  up() {
    const bitmap = this.draft?.bitmap;
    this.last = undefined;
    this.cancel();
    if (!bitmap) return;
    if (measured(bitmap).count) this.painted(this.on ?? null, bitmap);
    else if (this.on) this.desk.commit(withoutItems(this.desk.document, [this.on]), null);
  }

  colour() {
    return COLOURS.pin;
  }
}

/** Paints the region of a rig point: of the selected one where its region is painted, else of a new pin. */
export class RegionBrushTool extends BrushTool {
  target() {
    const chosen = this.desk.replacing ?? this.desk.selection;
    const item = itemAt(this.desk.document, chosen);
    const painted = chosen?.list === "rig_points" && item?.region?.type === "mask";
    return painted || this.desk.replacing ? chosen : null;
  }

  /**
   * @param {Reference | null} target
   * @param {Bitmap} bitmap
   */
  painted(target, bitmap) {
    const region = regionOf(bitmap);
    if (target) {
      const item = { ...itemAt(this.desk.document, target), region };
      this.desk.commit(withItem(this.desk.document, target, item), target);
      return;
    }
    const pin = newRigPoint(middleOf(this.desk.document, region), region);
    const { document, reference } = withAdded(this.desk.document, "rig_points", pin);
    this.desk.commit(document, reference);
  }
}

/** Paints where bodies are stiffer; goes on with the selected layer, or with the last one. */
export class StiffnessTool extends BrushTool {
  target() {
    const { document, selection } = this.desk;
    if (selection?.list === "paint" && itemAt(document, selection)?.region?.type === "mask") return selection;
    const layers = document.paint ?? [];
    const last = layers.findLastIndex((/** @type {Item} */ one) => one.region?.type === "mask");
    return last < 0 ? null : { list: "paint", index: last };
  }

  /**
   * @param {Reference | null} target
   * @param {Bitmap} bitmap
   */
  painted(target, bitmap) {
    const region = regionOf(bitmap);
    if (target) {
      const item = { ...itemAt(this.desk.document, target), region };
      this.desk.commit(withItem(this.desk.document, target, item), target);
      return;
    }
    const layer = { region, stiffness: 4 };
    const { document, reference } = withAdded(this.desk.document, "paint", layer);
    this.desk.commit(document, reference);
  }

  colour() {
    return COLOURS.paint;
  }
}
