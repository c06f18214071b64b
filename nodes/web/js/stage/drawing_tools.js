/**
 * Tools that draw strokes, led points, waves and single points.
 *
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("./tool.js").Desk} Desk
 */

import { say } from "../host/words.js";
import { withAdded, withItem } from "../scene/document.js";
import { distance, rounded, simplified } from "../scene/geometry.js";
import { newLead, newRigPoint, newStroke, newWave, usualCircle } from "../scene/items.js";
import { COLOURS } from "./colours.js";
import { Tool } from "./tool.js";

/** How far a drawn line may be smoothed, and what still counts as a click [pixels of the screen]. */
const SMOOTHING = 1.2;
const CLICK = 3;

/** Draws a line by hand. */
class Freehand extends Tool {
  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  down(point, event) {
    this.points = [point];
    this.times = [event.timeStamp / 1000];
    this.pressures = [event.pressure];
    this.pen = event.pointerType === "pen" && event.pressure > 0;
    this.draft = { path: this.points, colour: COLOURS[this.id] };
  }

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  move(point, event) {
    if (!this.points || !this.times || !this.pressures) return;
    if (distance(point, this.points[this.points.length - 1]) < this.desk.pixel) return;
    this.points.push(point);
    this.times.push(event.timeStamp / 1000);
    this.pressures.push(event.pressure);
    this.desk.redraw();
  }

  /** The drawn line with the fewest points that are true to it. */
  drawn() {
    const kept = simplified(this.points ?? [], SMOOTHING * this.desk.pixel);
    /** @type {<T>(values: T[] | undefined) => T[]} */
    const pick = (values) => kept.map((i) => /** @type {any} */ (values)[i]);
    const clicked = (this.points ?? []).every((point) => distance(point, this.points?.[0] ?? point) < CLICK * this.desk.pixel);
    return { path: pick(this.points), times: pick(this.times), pressures: this.pen ? pick(this.pressures) : [], clicked };
  }

  cancel() {
    this.points = undefined;
    super.cancel();
  }
}

export class StrokeTool extends Freehand {
  up() {
    if (!this.points) return;
    const kind = /** @type {"wind"} */ (this.id);
    const { path, pressures, clicked } = this.drawn();
    this.cancel();
    if (clicked && kind === "wind") {
      this.desk.say(say("Drag to draw where the wind blows."));
      return;
    }
    // A single point is a particle at rest, which has no way to go.
    const stroke = clicked ? { ...newStroke(this.desk.document, kind, [path[0]]), speed: 0 } : newStroke(this.desk.document, kind, path, pressures);
    const { document, reference } = withAdded(this.desk.document, "strokes", stroke);
    this.desk.commit(document, reference);
  }
}

export class LeadTool extends Freehand {
  up() {
    if (!this.points) return;
    const { path, times, clicked } = this.drawn();
    this.cancel();
    if (clicked) {
      this.desk.say(say("Drag to draw the way along which the point is led, as fast as it shall go."));
      return;
    }
    const { document, reference } = withAdded(this.desk.document, "rig_points", newLead(this.desk.document, path, times));
    this.desk.commit(document, reference);
  }
}

/** Places something that can still be moved until the pointer is released. */
class Placing extends Tool {
  /**
   * @param {Point} point
   * @param {PointerEvent} _event
   */
  down(point, _event) {
    this.origin = this.desk.document;
    this.start = point;
    this.#show(point);
  }

  /** @param {Point} point */
  move(point) {
    if (this.origin) this.#show(point);
  }

  up() {
    if (!this.origin || !this.placed) return;
    const { document, reference } = this.placed;
    this.origin = undefined;
    this.desk.commit(document, reference);
  }

  cancel() {
    if (this.origin) this.desk.propose(this.origin);
    this.origin = undefined;
    super.cancel();
  }

  /** @param {Point} point */
  #show(point) {
    if (!this.origin) return;
    this.placed = withAdded(this.origin, this.list(), this.item(point));
    this.desk.propose(this.placed.document);
  }

  list() {
    return "rig_points";
  }

  /**
   * @param {Point} point
   * @returns {Item}
   */
  item(point) {
    return newRigPoint(point, usualCircle(this.desk.document));
  }
}

export class PinTool extends Placing {}

export class WaveTool extends Placing {
  /** @param {Point} point */
  item(point) {
    const start = this.start ?? point;
    return newWave(this.desk.document, start, distance(start, point) < CLICK * this.desk.pixel ? start : point);
  }
}

export class QueryTool extends Placing {
  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  down(point, event) {
    this.beside = this.id === "query-negative" || event.altKey;
    if (event.shiftKey && !this.beside) this.desk.newPart();
    super.down(point, event);
  }

  list() {
    return "query_points";
  }

  /** @param {Point} point */
  item(point) {
    const { width, height } = this.desk.document;
    /** @type {Point} */
    const inside = [Math.min(Math.max(point[0], 0), width), Math.min(Math.max(point[1], 0), height)];
    const [x, y] = rounded(inside);
    const { part } = this.desk;
    return { x, y, positive: !this.beside, ...(part ? { part } : {}) };
  }
}

/** Draws a circle from its middle, as a new pin or as the region of one. */
export class CircleTool extends Tool {
  /** @param {Point} point */
  down(point) {
    this.draft = { circle: { at: point, radius: 0 }, colour: COLOURS.pin };
  }

  /** @param {Point} point */
  move(point) {
    const circle = this.draft?.circle;
    if (circle) circle.radius = distance(circle.at, point);
    this.desk.redraw();
  }

  up() {
    const circle = this.draft?.circle;
    this.cancel();
    if (!circle) return;
    const large = circle.radius >= CLICK * this.desk.pixel;
    const region = large ? { type: "circle", radius: Math.max(0.5, Math.round(circle.radius * 10) / 10) } : usualCircle(this.desk.document);
    addRegion(this.desk, region, circle.at);
  }
}

/**
 * A region becomes that of the rig point which waits for one, or a new pin.
 *
 * @param {Desk} desk
 * @param {Item} region
 * @param {Point} position
 */
export function addRegion(desk, region, position) {
  const waiting = desk.replacing;
  if (waiting) {
    const item = { ...desk.document[waiting.list][waiting.index], region };
    // A circle lies about the position, other regions where they were drawn.
    const moved = region.type === "circle" ? { ...item, position: rounded(position) } : item;
    desk.commit(withItem(desk.document, waiting, moved), waiting);
    return;
  }
  const { document, reference } = withAdded(desk.document, "rig_points", newRigPoint(position, region));
  desk.commit(document, reference);
}
