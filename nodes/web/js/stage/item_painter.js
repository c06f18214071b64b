/**
 * How each kind of item looks on the picture.
 *
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/geometry.js").View} View
 */

import { along, lengthOf, toStage } from "../scene/geometry.js";
import { handlesOf, verticesOf } from "../scene/shapes.js";
import { colourOf } from "./colours.js";
import { Painter } from "./painter.js";
import { regionMask } from "./tints.js";

/** Distance from one arrow of a wind stroke to the next [CSS px]. */
const ARROWS = 70;
const MANY_POINTS = 400;

/**
 * Whether a rig point is led away from where it was drawn.
 *
 * @param {Item} rigPoint
 */
export function moves(rigPoint) {
  return (rigPoint.motion?.type ?? "pinned") !== "pinned";
}

export class ItemPainter {
  /**
   * @param {CanvasRenderingContext2D} context
   * @param {View} view
   * @param {SceneDocument} document
   */
  constructor(context, view, document) {
    this.context = context;
    this.view = view;
    this.document = document;
    this.painter = new Painter(context);
    /** @type {(point: Point) => Point} */
    this.at = (point) => toStage(view, point);
  }

  /**
   * @param {Reference} reference
   * @param {Item} item
   * @param {boolean} selected
   */
  draw(reference, item, selected) {
    const colour = colourOf(reference.list, item);
    if (reference.list === "strokes") this.#stroke(item, colour, selected);
    else if (reference.list === "rig_points") this.#rigPoint(item, colour, selected);
    else if (reference.list === "query_points") this.#query(item, colour, selected);
    else this.#region(item, colour, selected);
    if (selected) this.#grips(reference, item, colour);
  }

  /**
   * @param {Item} stroke
   * @param {string} colour
   * @param {boolean} selected
   */
  #stroke(stroke, colour, selected) {
    const path = (stroke.path ?? []).map(this.at);
    if (!path.length) return;
    if (selected) this.painter.band(path, colour, (stroke.radius ?? 200) * this.view.scale);
    this.painter.line(path, colour, { width: selected ? 3 : 2 });
    if (stroke.kind === "repel" || stroke.kind === "attract") this.#burst(path[0], colour, stroke.kind === "repel");
    else this.painter.dot(path[0], 3.5, colour);
    const length = lengthOf(path);
    const count = Math.min(Math.max(1, Math.round(length / ARROWS)), 12);
    const back = stroke.kind === "wind" && stroke.strength < 0 ? -1 : 1;
    for (let k = 1; k <= count && length > 6; k++) {
      const { point, direction } = along(path, k / count);
      this.painter.arrowhead(point, [direction[0] * back, direction[1] * back], colour, k === count ? 11 : 8);
    }
  }

  /**
   * Four arrows away from a point, or towards it.
   *
   * @param {Point} at
   * @param {string} colour
   * @param {boolean} away
   */
  #burst([x, y], colour, away) {
    this.painter.dot([x, y], 4, colour);
    for (const [dx, dy] of /** @type {Point[]} */ ([[1, 0], [-1, 0], [0, 1], [0, -1]])) {
      const tip = away ? 15 : 10;
      this.painter.arrowhead([x + dx * tip, y + dy * tip], away ? [dx, dy] : [-dx, -dy], colour, 7);
    }
  }

  /**
   * @param {Item} item
   * @param {string} colour
   * @param {boolean} selected
   */
  #rigPoint(item, colour, selected) {
    this.#region({ ...item, region: item.region ?? { type: "circle", radius: 20 } }, colour, selected);
    this.#motion(item, colour);
    if (!moves(item)) this.anchor(item, [0, 0]);
  }

  /**
   * The rig point itself, which may be on its way.
   *
   * @param {Item} item
   * @param {Point} shift  from where it was drawn [px]
   */
  anchor(item, [dx, dy]) {
    const { position } = item;
    const colour = colourOf("rig_points", item);
    const at = this.at([position[0] + dx, position[1] + dy]);
    if (dx || dy) this.painter.line([this.at(position), at], colour, { width: 1, dash: [3, 3] });
    this.painter.dot(at, 6, colour);
    this.painter.dot(at, 2, "#fff");
  }

  /**
   * @param {Item} item
   * @param {string} colour
   */
  #motion(item, colour) {
    const [x, y] = item.position;
    const motions = item.motion?.type === "combined" ? item.motion.motions : [item.motion ?? {}];
    for (const motion of motions) {
      if (motion.type === "path") this.#led(motion.points.map(this.at), colour);
      else if (motion.type === "wave") {
        const [dx, dy] = motion.direction ?? [1, 0];
        const reach = (motion.amplitude ?? 20) / (Math.hypot(dx, dy) || 1);
        this.#swing(this.at([x - dx * reach, y - dy * reach]), this.at([x + dx * reach, y + dy * reach]), colour);
      } else if (motion.type === "swing") this.#turn(this.at([x, y]), motion.amplitude ?? 10, -(motion.amplitude ?? 10), colour);
      else if (motion.type === "rotation") this.#turn(this.at([x, y]), motion.angles.at(-1) - motion.angles[0], 0, colour);
      else if (motion.type === "squash" || motion.type === "pulse") {
        const angle = ((motion.angle ?? 90) * Math.PI) / 180;
        const [cx, cy] = this.at([x, y]);
        const [ux, uy] = [Math.cos(angle) * 28, -Math.sin(angle) * 28];
        this.#swing([cx - ux, cy - uy], [cx + ux, cy + uy], colour);
      }
    }
  }

  /**
   * @param {Point[]} path
   * @param {string} colour
   */
  #led(path, colour) {
    this.painter.line(path, colour, { dash: [6, 4] });
    for (const point of path.slice(1, -1)) this.painter.dot(point, 2.5, colour);
    const { point, direction } = along(path, 1);
    this.painter.arrowhead(point, direction, colour, 11);
  }

  /**
   * @param {Point} from
   * @param {Point} to
   * @param {string} colour
   */
  #swing(from, to, colour) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]) || 1;
    /** @type {Point} */
    const direction = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
    this.painter.line([from, to], colour);
    this.painter.arrowhead(to, direction, colour);
    this.painter.arrowhead(from, [-direction[0], -direction[1]], colour);
  }

  /**
   * An arc about a point.
   *
   * @param {Point} at
   * @param {number} to  [degrees], counterclockwise
   * @param {number} from
   * @param {string} colour
   */
  #turn([x, y], to, from, colour) {
    const radius = 32;
    /** @type {Point[]} */
    const arc = [];
    for (let k = 0; k <= 24; k++) {
      const angle = ((from + ((to - from) * k) / 24 + 90) * Math.PI) / 180;
      arc.push([x + radius * Math.cos(angle), y - radius * Math.sin(angle)]);
    }
    this.painter.line(arc, colour);
    this.painter.arrowhead(arc[24], along(arc, 1).direction, colour);
    if (from) this.painter.arrowhead(arc[0], along([...arc].reverse(), 1).direction, colour);
  }

  /**
   * @param {Item} item
   * @param {string} colour
   * @param {boolean} selected
   */
  #region({ region, position, falloff }, colour, selected) {
    const fill = `${colour}${selected ? "38" : "1f"}`;
    const width = selected ? 2 : 1.5;
    if (region?.type === "polygon") this.painter.line(region.points.map(this.at), colour, { closed: true, width, fill });
    if (region?.type === "mask") this.mask(region, colour, selected ? 0.55 : 0.35);
    if (region?.type !== "circle") return;
    this.painter.circle(this.at(position), region.radius * this.view.scale, colour, { width, fill });
    if (falloff > 0) {
      this.painter.circle(this.at(position), (region.radius + falloff) * this.view.scale, colour, { width: 1, dash: [3, 4] });
    }
  }

  /**
   * @param {any} region
   * @param {string} colour
   * @param {number} alpha
   */
  mask(region, colour, alpha) {
    this.stretched(regionMask(region, colour), alpha);
  }

  /**
   * @param {CanvasImageSource | undefined} image  over the whole picture
   * @param {number} alpha
   */
  stretched(image, alpha) {
    if (!image) return;
    const { context, view, document } = this;
    context.globalAlpha = alpha;
    context.drawImage(image, view.x, view.y, document.width * view.scale, document.height * view.scale);
    context.globalAlpha = 1;
  }

  /**
   * @param {Item} item
   * @param {string} colour
   * @param {boolean} selected
   */
  #query(item, colour, selected) {
    const [x, y] = this.at([item.x, item.y]);
    this.painter.dot([x, y], selected ? 9 : 7.5, colour);
    const { context } = this;
    context.strokeStyle = "#fff";
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x - 4, y);
    context.lineTo(x + 4, y);
    if (item.positive !== false) {
      context.moveTo(x, y - 4);
      context.lineTo(x, y + 4);
    }
    context.stroke();
  }

  /**
   * @param {Reference} reference
   * @param {Item} item
   * @param {string} colour
   */
  #grips(reference, item, colour) {
    const vertices = verticesOf(reference, item);
    if (vertices.length <= MANY_POINTS) {
      for (const { id, at } of vertices) if (id !== "position") this.painter.square(this.at(at), colour);
    }
    for (const { at, from } of handlesOf(this.document, reference, item)) {
      if (from) this.painter.line([this.at(from), this.at(at)], colour, { width: 1, dash: [2, 3] });
      this.painter.dot(this.at(at), 5.5, "#fff");
      this.painter.dot(this.at(at), 3.5, colour);
    }
  }
}
