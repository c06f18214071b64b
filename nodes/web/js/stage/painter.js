/**
 * Basic marks on the overlay, in CSS pixels of the stage; every line has a dark edge.
 *
 * @typedef {import("../scene/document.js").Point} Point
 */

import { COLOURS } from "./colours.js";

export class Painter {
  /** @param {CanvasRenderingContext2D} context */
  constructor(context) {
    this.context = context;
  }

  /**
   * @param {Point[]} path
   * @param {string} colour
   * @param {{width?: number, closed?: boolean, dash?: number[], fill?: string}} [style]
   */
  line(path, colour, { width = 2, closed = false, dash = [], fill = "" } = {}) {
    const { context } = this;
    context.beginPath();
    path.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
    if (closed) context.closePath();
    this.#inked(colour, width, dash, fill);
  }

  /**
   * @param {Point} at
   * @param {number} radius
   * @param {string} colour
   * @param {{width?: number, dash?: number[], fill?: string}} [style]
   */
  circle([x, y], radius, colour, { width = 2, dash = [], fill = "" } = {}) {
    this.context.beginPath();
    this.context.arc(x, y, Math.max(radius, 0), 0, 2 * Math.PI);
    this.#inked(colour, width, dash, fill);
  }

  /**
   * A filled dot with a dark edge.
   *
   * @param {Point} at
   * @param {number} radius
   * @param {string} colour
   */
  dot([x, y], radius, colour) {
    const { context } = this;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fillStyle = colour;
    context.strokeStyle = COLOURS.edge;
    context.lineWidth = 1.5;
    context.fill();
    context.stroke();
  }

  /**
   * @param {Point} at
   * @param {string} colour
   */
  square([x, y], colour) {
    const { context } = this;
    context.fillStyle = "#fff";
    context.strokeStyle = COLOURS.edge;
    context.lineWidth = 4;
    context.strokeRect(x - 3.5, y - 3.5, 7, 7);
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.strokeRect(x - 3.5, y - 3.5, 7, 7);
    context.fillRect(x - 3, y - 3, 6, 6);
  }

  /**
   * @param {Point} tip
   * @param {Point} direction  of length 1
   * @param {string} colour
   * @param {number} size
   */
  arrowhead([x, y], [dx, dy], colour, size = 9) {
    const { context } = this;
    context.beginPath();
    context.moveTo(x + dx * size * 0.5, y + dy * size * 0.5);
    context.lineTo(x - dx * size * 0.6 - dy * size * 0.55, y - dy * size * 0.6 + dx * size * 0.55);
    context.lineTo(x - dx * size * 0.3, y - dy * size * 0.3);
    context.lineTo(x - dx * size * 0.6 + dy * size * 0.55, y - dy * size * 0.6 - dx * size * 0.55);
    context.closePath();
    context.fillStyle = colour;
    context.strokeStyle = COLOURS.edge;
    context.lineWidth = 1.5;
    context.stroke();
    context.fill();
  }

  /**
   * How far a stroke reaches, as a broad translucent band.
   *
   * @param {Point[]} path
   * @param {string} colour
   * @param {number} radius
   */
  band(path, colour, radius) {
    const { context } = this;
    context.save();
    context.beginPath();
    path.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
    if (path.length === 1) context.lineTo(path[0][0] + 0.01, path[0][1]);
    context.globalAlpha = 0.18;
    context.lineCap = context.lineJoin = "round";
    context.lineWidth = radius * 2;
    context.strokeStyle = colour;
    context.stroke();
    context.restore();
  }

  /**
   * Words on a dark ground.
   *
   * @param {Point} at
   * @param {string} text
   * @param {CanvasTextAlign} align
   */
  label([x, y], text, align = "left") {
    const { context } = this;
    context.font = "12px system-ui, sans-serif";
    context.textAlign = align;
    context.textBaseline = "middle";
    const width = context.measureText(text).width + 10;
    const left = align === "center" ? x - width / 2 : x;
    context.fillStyle = "rgba(10, 12, 16, 0.8)";
    context.beginPath();
    context.roundRect(left, y - 9, width, 18, 4);
    context.fill();
    context.fillStyle = "#fff";
    context.fillText(text, align === "center" ? x : x + 5, y + 0.5);
  }

  /**
   * @param {string} colour
   * @param {number} width
   * @param {number[]} dash
   * @param {string} fill
   */
  #inked(colour, width, dash, fill) {
    const { context } = this;
    context.lineCap = context.lineJoin = "round";
    if (fill) {
      context.fillStyle = fill;
      context.fill();
    }
    context.setLineDash(dash);
    context.strokeStyle = COLOURS.edge;
    context.lineWidth = width + 2;
    context.stroke();
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke();
    context.setLineDash([]);
  }
}
