/**
 * The place where the picture lies: three canvases, the view on them, and the pointer.
 *
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/geometry.js").View} View
 */

import { say } from "../host/words.js";
import { isUsed } from "../panels/elements.js";
import { mark, PEN_UP } from "../preview/marks.js";
import { fittingView, startingView, toPicture, zoomed } from "../scene/geometry.js";
import { ScrollBars } from "./scroll_bars.js";

const MARGIN = 10;
const WHEEL = 0.0015;
/** What Page Up and Page Down go on by, in lengths of the stage. */
const PAGE = 0.8;
const MOST_PIXELS = 4096;

/**
 * @typedef {object} StageListener
 * @property {(point: Point, event: PointerEvent) => void} down
 * @property {(point: Point, event: PointerEvent) => void} move
 * @property {(point: Point, event: PointerEvent) => void} up
 * @property {(point: Point | null) => void} hover
 * @property {() => void} cancel
 * @property {() => void} double
 * @property {() => void} redraw
 */

export class Stage {
  /**
   * @param {HTMLElement} root
   * @param {import("../scene/document.js").SceneDocument} document  whose size the picture has
   * @param {StageListener} listener
   */
  constructor(root, { width, height }, listener) {
    this.root = root;
    this.size = { width, height };
    this.listener = listener;
    this.film = canvas("physanimator-film");
    this.still = canvas("physanimator-still");
    this.overlay = canvas("physanimator-overlay");
    // Pointer and keys go to an input, because every host leaves inputs with the focus alone: Delete would take the node,
    // Ctrl+Z the last change of the graph, and the middle button would move the graph.
    this.keys = document.createElement("input");
    Object.assign(this.keys, { className: "physanimator-keys", readOnly: true, inputMode: "none" });
    this.keys.setAttribute("aria-label", say("Picture"));
    this.bars = new ScrollBars((dx, dy) => this.#scroll(dx, dy));
    root.append(this.film, this.still, this.overlay, this.keys, ...this.bars.roots);
    /** @type {View} */
    this.view = { scale: 1, x: 0, y: 0 };
    /** Size of the stage [CSS px]; kept, because asking the page for it may make it lay everything out. */
    this.across = this.down = 0;
    /** @type {Point} of the picture, around which a long page is shown */
    this.about = [0, 0];
    /** Whether the view follows the size of the stage, and whether it shows the whole of a long page then. */
    this.fitted = true;
    this.whole = false;
    this.panning = false;
    this.panned = false;
    this.spaceHeld = false;
    /** @type {Map<number, Point>} pointers that touch, on the stage */
    this.touching = new Map();
    this.active = -1;
    this.#listen();
    this.observer = new ResizeObserver(() => this.resized());
    this.observer.observe(root);
  }

  focus() {
    this.keys.focus({ preventScroll: true });
  }

  /**
   * @param {import("../scene/document.js").SceneDocument} size
   * @param {Point} [about]  where the work is
   * @returns {boolean} whether it is another one
   */
  setSize({ width, height }, about = [0, 0]) {
    if (width === this.size.width && height === this.size.height) return false;
    this.size = { width, height };
    this.begin(about);
    return true;
  }

  /** @param {Point} [about]  of the picture, which is shown of a long page; what is in the middle now if left out */
  begin(about = this.across && this.down ? toPicture(this.view, [this.across / 2, this.down / 2]) : this.about) {
    Object.assign(this, { fitted: true, whole: false });
    this.about = about;
    this.#measure();
    if (!this.across || !this.down) return;
    this.view = startingView(this.size.width, this.size.height, this.across, this.down, MARGIN, about);
    this.listener.redraw();
  }

  fit() {
    Object.assign(this, { fitted: true, whole: true });
    this.#measure();
    if (!this.across || !this.down) return;
    this.view = fittingView(this.size.width, this.size.height, this.across, this.down, MARGIN);
    this.listener.redraw();
  }

  /** The picture is shown elsewhere, in another size. */
  moved() {
    if (this.whole) this.fit();
    else this.begin();
  }

  /** @param {number} pages  to go on along the longer side of the picture */
  turn(pages) {
    const wide = this.size.width * this.down > this.size.height * this.across;
    this.#scroll(wide ? pages * PAGE * this.across : 0, wide ? 0 : pages * PAGE * this.down);
  }

  /**
   * @param {number} dx  on the stage [CSS px], to the right; no farther than the picture reaches
   * @param {number} dy
   */
  #scroll(dx, dy) {
    const { view, size } = this;
    const x = scrolled(view.x, dx, size.width * view.scale, this.across);
    const y = scrolled(view.y, dy, size.height * view.scale, this.down);
    if (x === view.x && y === view.y) return;
    this.view = { ...view, x, y };
    this.fitted = false;
    this.listener.redraw();
  }

  /**
   * @param {number} factor
   * @param {Point} [about]  on the stage
   */
  zoom(factor, about = [this.across / 2, this.down / 2]) {
    const least = fittingView(this.size.width, this.size.height, this.across, this.down, MARGIN).scale / 4;
    this.view = zoomed(this.view, about, factor, least);
    this.fitted = false;
    this.listener.redraw();
  }

  resized() {
    this.#measure();
    if (this.fitted && this.whole) this.fit();
    else if (this.fitted) this.begin(this.about);
    this.listener.redraw();
  }

  #measure() {
    this.across = this.root.clientWidth;
    this.down = this.root.clientHeight;
  }

  /**
   * Give the canvases as many pixels as the screen shows, also where the graph is zoomed.
   *
   * @returns {boolean} whether they had others, and so have lost what was on them
   */
  sharpen() {
    const shown = this.overlay.getBoundingClientRect().width / (this.across || 1);
    const ratio = Math.min(Math.max(1, shown) * (globalThis.devicePixelRatio || 1), MOST_PIXELS / Math.max(this.across, this.down, 1));
    const size = [Math.max(1, Math.round(this.across * ratio)), Math.max(1, Math.round(this.down * ratio))];
    if (this.overlay.width === size[0] && this.overlay.height === size[1]) return false;
    for (const one of [this.film, this.still, this.overlay]) [one.width, one.height] = size;
    return true;
  }

  /**
   * @param {HTMLCanvasElement} one
   * @returns {CanvasRenderingContext2D} on which nothing is left, in CSS pixels of the stage
   */
  wiped(one) {
    const context = /** @type {CanvasRenderingContext2D} */ (one.getContext("2d"));
    context.setTransform(one.width / (this.across || 1), 0, 0, one.height / (this.down || 1), 0, 0);
    context.clearRect(0, 0, this.across, this.down);
    return context;
  }

  /**
   * Where an event is on the stage [CSS px], whatever the zoom of the graph.
   *
   * @param {MouseEvent} event
   * @returns {Point}
   */
  place(event) {
    const box = this.overlay.getBoundingClientRect();
    const [across, down] = [this.across / (box.width || 1), this.down / (box.height || 1)];
    return [(event.clientX - box.left) * across, (event.clientY - box.top) * down];
  }

  #listen() {
    const { keys } = this;
    keys.addEventListener("pointerdown", (event) => this.#down(event));
    keys.addEventListener("pointermove", (event) => this.#move(event));
    keys.addEventListener("pointerup", (event) => this.#up(event));
    keys.addEventListener("pointercancel", (event) => this.#lost(event));
    keys.addEventListener("pointerleave", () => this.listener.hover(null));
    keys.addEventListener("dblclick", () => this.listener.double());
    keys.addEventListener("contextmenu", (event) => event.preventDefault());
    keys.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
  }

  /** @param {PointerEvent} event */
  #down(event) {
    event.preventDefault();
    this.focus();
    try {
      this.keys.setPointerCapture(event.pointerId);
    } catch {
      // The pointer may be gone already; without capture it is followed as far as the canvas reaches.
    }
    const at = this.place(event);
    this.touching.set(event.pointerId, at);
    if (event.pointerType === "touch" && this.touching.size === 2) {
      this.#giveUp();
      this.panning = true;
    } else if (event.button === 1 || this.spaceHeld) this.panning = this.panned = true;
    else if (event.button === 0 || event.button === 5) {
      this.active = event.pointerId;
      this.listener.down(toPicture(this.view, at), event);
    }
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const at = this.place(event);
    const before = this.touching.get(event.pointerId);
    if (before && this.panning) {
      this.#pan(event.pointerId, before, at);
      return;
    }
    if (before) this.touching.set(event.pointerId, at);
    if (event.pointerId !== this.active) {
      if (!before) this.listener.hover(toPicture(this.view, at));
      return;
    }
    const passed = event.getCoalescedEvents?.() ?? [];
    for (const one of passed.length ? passed : [event]) {
      this.listener.move(toPicture(this.view, this.place(one)), one);
    }
    this.listener.hover(toPicture(this.view, at));
  }

  /** @param {PointerEvent} event */
  #up(event) {
    const at = this.place(event);
    this.touching.delete(event.pointerId);
    if (!this.touching.size) this.panning = false;
    if (event.pointerId !== this.active) return;
    this.active = -1;
    mark(PEN_UP, event.timeStamp);
    this.listener.up(toPicture(this.view, at), event);
  }

  /** @param {PointerEvent} event */
  #lost(event) {
    this.touching.delete(event.pointerId);
    if (!this.touching.size) this.panning = false;
    if (event.pointerId === this.active) this.#giveUp();
  }

  #giveUp() {
    this.active = -1;
    this.listener.cancel();
  }

  /**
   * One finger or the mouse pans, two fingers zoom as well.
   *
   * @param {number} pointer
   * @param {Point} before
   * @param {Point} at
   */
  #pan(pointer, before, at) {
    const other = [...this.touching].find(([id]) => id !== pointer)?.[1];
    this.touching.set(pointer, at);
    const share = other ? 0.5 : 1;
    this.view = { ...this.view, x: this.view.x + (at[0] - before[0]) * share, y: this.view.y + (at[1] - before[1]) * share };
    this.fitted = false;
    if (other) {
      const [was, is] = [before, at].map((one) => Math.hypot(one[0] - other[0], one[1] - other[1]) || 1);
      this.zoom(is / was, [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2]);
    }
    this.listener.redraw();
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    const editor = /** @type {HTMLElement | null} */ (this.root.closest(".physanimator-editor"));
    if (editor && !isUsed(editor)) return;
    event.preventDefault();
    event.stopPropagation();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY);
    // With Shift some browsers turn the wheel sideways themselves.
    if (event.shiftKey) return this.turn(((event.deltaX || event.deltaY) * lines) / (PAGE * Math.max(this.across, this.down, 1)));
    if (sideways) return this.#scroll(event.deltaX * lines, 0);
    this.zoom(Math.exp(-event.deltaY * lines * WHEEL), this.place(event));
  }

  release() {
    this.observer.disconnect();
  }
}

/**
 * @param {number} at  where the picture begins on the stage
 * @param {number} by
 * @param {number} length  of the picture
 * @param {number} room  of the stage
 * @returns {number} where it begins then, without leaving more of the stage empty than is
 */
function scrolled(at, by, length, room) {
  const [least, most] = [Math.min(room - MARGIN - length, at, MARGIN), Math.max(MARGIN, at)];
  return length <= room ? at : Math.min(Math.max(at - by, least), most);
}

/** @param {string} name */
function canvas(name) {
  return Object.assign(document.createElement("canvas"), { className: name });
}
