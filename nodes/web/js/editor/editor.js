/**
 * The editor: puts the parts together. It knows nothing of the host; what it needs of it is handed in.
 *
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 *
 * @typedef {object} EditorOptions
 * @property {{read: (text: string) => SceneDocument, write: (document: SceneDocument) => string}} format  of the value
 * @property {string[][]} groups  of buttons
 * @property {boolean} moves  whether there is time and motion
 * @property {import("../preview/client.js").Fetch} fetch
 * @property {(text: string) => void} onChange  a new value
 * @property {() => void} onRun  the user wants this node to run
 */

import { Inspector } from "../panels/inspector.js";
import { Timeline } from "../panels/timeline.js";
import { Toolbar } from "../panels/toolbar.js";
import { element } from "../panels/elements.js";
import { STYLE } from "../panels/style.js";
import { emptyDocument, hasItems, itemAt, withValue } from "../scene/document.js";
import { sideOf } from "../scene/items.js";
import { rescaled } from "../scene/rescaling.js";
import { handlesOf } from "../scene/shapes.js";
import { drawOverlay } from "../stage/overlay.js";
import { Scheduler } from "../stage/scheduler.js";
import { Stage } from "../stage/stage.js";
import { Commands } from "./commands.js";
import { listenTo } from "./input.js";
import { Live } from "./live.js";
import { Notes } from "./notes.js";
import { loaded } from "./pictures.js";
import { Store } from "./store.js";
import { BRUSHES, toolsOf } from "./toolbox.js";

/** Length of a preview [s], where the scene is no loop. */
const PREVIEW = 3;

export class Editor {
  /** @param {EditorOptions} options */
  constructor(options) {
    this.options = options;
    this.store = new Store(emptyDocument(1280, 720), () => this.#show(), () => this.#keep());
    this.notes = new Notes();
    this.toolbar = new Toolbar(options.groups, (id) => this.commands.run(id));
    this.scheduler = new Scheduler((now) => this.#draw(now));
    this.#build();
    this.live = new Live(this.stage.film, options.fetch, {
      redraw: () => this.redraw(),
      trouble: (error) => this.#trouble(error),
      started: () => this.notes.show("run", ""),
    });
    this.shown = { mesh: false, items: true, panel: options.moves };
    this.brushRadius = 20;
    /** @type {Reference | null} */
    this.replacing = null;
    /** @type {Point | null} */
    this.pointer = null;
    /** @type {HTMLImageElement | null} */
    this.picture = null;
    this.seconds = PREVIEW;
    this.frames = 0;
    this.text = "";
    this.tools = toolsOf(/** @type {any} */ (this), options.groups.flat());
    this.tool = /** @type {import("../stage/tool.js").Tool} */ (this.tools.get(options.groups[0][0]));
    this.commands = new Commands(this);
    listenTo(this);
    this.#show();
  }

  #build() {
    const place = element("div", { className: "physanimator-stage" });
    this.stage = new Stage(place, this.store.document, {
      down: (point, event) => this.#press(point, event),
      move: (point, event) => this.tool.move(point, event),
      up: (point, event) => this.tool.up(point, event),
      hover: (point) => this.#hover(point),
      cancel: () => this.tool.cancel(),
      double: () => this.tool.finish(),
      redraw: () => this.redraw(),
    });
    place.append(this.notes.root);
    this.inspector = new Inspector({
      change: (reference, changes, key) => this.#edit(reference, changes, key),
      redrawRegion: (kind) => this.commands.redrawRegion(kind),
      brushSize: (radius) => this.commands.setBrush(radius),
    });
    this.timeline = new Timeline({
      toggle: () => this.commands.run("play"),
      loop: () => this.commands.run("loop"),
      seek: (frame) => this.commands.seek(frame),
      length: (frames) => this.commands.setLength(frames),
      select: (reference) => this.select(reference),
    });
    this.frame = element("div", { className: "physanimator-frame" }, [this.toolbar.root, place, this.inspector.root, ...(this.options.moves ? [this.timeline.root] : [])]);
    this.dialog = element("dialog", { className: "physanimator-dialog", "aria-label": "Scene editor", onclose: () => this.commands.shrink() });
    this.root = element("div", { className: "physanimator-editor", "data-capture-wheel": "true" }, [element("style", { textContent: STYLE }), this.frame, this.dialog]);
  }

  // What the tools use.

  get document() {
    return this.store.document;
  }

  get selection() {
    return this.store.selection;
  }

  get pixel() {
    return 1 / this.stage.view.scale;
  }

  /** Handles of the selected item. */
  get handles() {
    const item = itemAt(this.document, this.selection);
    return item && this.selection ? handlesOf(this.document, this.selection, item) : [];
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} [selection]
   * @param {string} [key]
   */
  commit(document, selection, key) {
    this.replacing = null;
    this.store.commit(document, selection, key);
  }

  /** @param {SceneDocument} document */
  propose(document) {
    this.store.propose(document);
  }

  /** @param {Reference | null} reference */
  select(reference) {
    this.replacing = null;
    this.store.select(reference);
  }

  /** @param {string} sentence */
  say(sentence) {
    this.notes.say(sentence);
  }

  redraw() {
    this.scheduler.request();
  }

  // What the host uses.

  /** @param {string} text the value of the node */
  load(text) {
    if (text === this.text) return;
    this.text = text;
    try {
      const document = this.options.format.read(text);
      this.notes.show("value", "");
      this.store.load(document);
      this.stage.setSize(document);
      this.brushRadius = Math.round(sideOf(document) * 0.02);
    } catch (error) {
      const anew = () => this.commit(emptyDocument(this.document.width, this.document.height), null);
      this.notes.show("value", /** @type {Error} */ (error).message, { kind: "error", button: ["Start anew", anew] });
    }
    if (this.picture) this.#fitTo(this.picture.naturalWidth, this.picture.naturalHeight);
    this.simulate();
  }

  /**
   * A picture to draw on.
   *
   * @param {string | null} url
   */
  async setPicture(url) {
    this.wanted = url;
    if (!url) return;
    try {
      const picture = await loaded(url);
      if (this.wanted === url) this.#take(picture);
    } catch (error) {
      if (this.wanted === url) this.notes.say(/** @type {Error} */ (error).message);
    }
  }

  /**
   * What a run of the node has left.
   *
   * @param {import("./live.js").Run} run
   */
  async setRun(run) {
    const picture = run.image ? await loaded(run.image) : this.picture;
    if (run.image) this.wanted = null;
    if (picture) this.#take(picture);
    await this.live.setRun(run, picture);
    this.simulate();
    // Made when first asked for, which takes a moment; without one the picture itself is behind the bodies.
    const plate = await loaded(run.plate).catch(() => null);
    if (plate) this.live.setPlate(run, plate);
  }

  /** Nothing is known of the bodies any more, such as when another picture is chosen. */
  forgetRun() {
    this.live.setRun(null, null);
    this.#offerRun("");
    this.redraw();
  }

  simulate() {
    if (!this.options.moves) return;
    if (this.live.run) this.live.request(this.document, this.frameCount);
    else this.#offerRun("");
  }

  get frameCount() {
    const rate = this.document.frame_rate ?? 24;
    return this.frames || Math.max(2, Math.round((this.document.loop ?? this.seconds) * rate));
  }

  release() {
    this.root.dataset.released = "true";
    this.scheduler.stop();
    this.stage.release();
    this.live.release();
    this.dialog.close?.();
  }

  // How the parts answer.

  /** @param {HTMLImageElement} picture */
  #take(picture) {
    this.picture = picture;
    this.#fitTo(picture.naturalWidth, picture.naturalHeight);
    this.redraw();
  }

  /**
   * The scene over a picture of another size: what is drawn is scaled along, once.
   *
   * @param {number} width  [px]
   * @param {number} height
   */
  #fitTo(width, height) {
    const before = this.document;
    if (before.width === width && before.height === height) return;
    // Points from a plain list are pixels of the picture, whatever its size.
    const after = before.sizeless ? { ...before, width, height, sizeless: undefined } : rescaled(before, width, height);
    if (hasItems(before) && !before.sizeless) {
      this.commit(after, this.selection);
      this.say(`The picture is ${width} × ${height} px now; what is drawn has been scaled along from ${before.width} × ${before.height} px.`);
    } else this.store.load(after);
    this.stage.setSize(after);
    this.brushRadius = Math.round(sideOf(after) * 0.02);
  }

  #keep() {
    this.text = this.options.format.write(this.document);
    this.notes.show("value", "");
    this.stage.setSize(this.document);
    this.options.onChange(this.text);
    this.simulate();
  }

  /**
   * @param {Reference | null} reference
   * @param {[string, any][]} changes
   * @param {string} key
   */
  #edit(reference, changes, key) {
    const { document } = this;
    /** @type {(holder: any) => any} */
    const changed = (holder) => changes.reduce((made, [path, value]) => withValue(made, path, value), holder);
    if (!reference) this.commit(changed(document), this.selection, key);
    else {
      const entries = [...document[reference.list]];
      entries[reference.index] = changed(entries[reference.index]);
      this.commit({ ...document, [reference.list]: entries }, reference, key);
    }
  }

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  #press(point, event) {
    this.pointer = point;
    this.tool.down(point, event);
    this.redraw();
  }

  /** @param {Point | null} point */
  #hover(point) {
    this.pointer = point;
    if (point) this.tool.hover(point);
    this.stage.overlay.style.cursor = this.stage.spaceHeld ? "grab" : this.tool.cursor;
    if (BRUSHES.includes(this.tool.id)) this.redraw();
  }

  /** @param {Error | null} error */
  #trouble(error) {
    const gone = /** @type {any} */ (error)?.status === 404;
    this.notes.show("motion", error && !gone ? error.message : "", { kind: "error" });
    if (gone) this.live.setRun(null, null);
    if (gone) this.#offerRun(/** @type {Error} */ (error).message);
  }

  /** @param {string} reason why nothing moves; empty for the usual one */
  #offerRun(reason) {
    const text = reason || "Nothing moves yet: the bodies are known once this node has run.";
    this.notes.show("run", text, { button: ["Run this node", this.options.onRun] });
  }

  /** Bring everything but the picture up to date. */
  #show() {
    if (!this.commands) return;
    const { history, selection, document } = this.store;
    const pressed = { ...this.shown, expand: this.dialog.open };
    for (const id of this.tools.keys()) Object.assign(pressed, { [id]: id === this.tool.id });
    const { length } = history.past;
    this.toolbar.show(pressed, { undo: !length, redo: !history.future.length, duplicate: !selection, delete: !selection });
    this.frame.dataset.panel = String(this.shown.panel);
    this.frame.dataset.tool = this.tool.id;
    const brush = BRUSHES.includes(this.tool.id) && this.tool.id !== "erase" ? { radius: this.brushRadius } : null;
    this.inspector.show(document, selection, brush);
    const { playback } = this.live;
    playback.duration = this.frameCount;
    playback.frameRate = document.frame_rate ?? 24;
    this.timeline.showItems(document, selection, this.frameCount / playback.frameRate);
    this.redraw();
  }

  show() {
    this.#show();
  }

  /** @param {number} now */
  #draw(now) {
    const { stage, live } = this;
    const more = live.playback.advance(now);
    const context = stage.sharpen();
    live.draw(stage.view, stage.across, stage.down);
    const brushing = BRUSHES.includes(this.tool.id) && this.pointer;
    drawOverlay(context, {
      document: this.document,
      selection: this.selection,
      view: stage.view,
      background: live.shows ? null : this.picture,
      mesh: this.shown.mesh || !live.player.mesh ? live.mesh : null,
      frame: live.playback.shown,
      unit: live.unit,
      draft: this.tool.draft,
      brush: brushing ? { at: brushing, radius: this.brushRadius } : null,
      itemsShown: this.shown.items,
    });
    if (this.options.moves) this.timeline.showPosition(live.playback);
    return more;
  }
}
