/**
 * What buttons and keys do.
 *
 * @typedef {import("./editor.js").Editor} Editor
 */

import { say } from "../host/words.js";
import { itemAt, withAdded, withItem, withoutItems } from "../scene/document.js";
import { sideOf } from "../scene/items.js";
import { withAttach, withHoldsAnew } from "../scene/holds.js";
import { withMoves, withOfBody, withPlace, withPreset } from "../scene/layers.js";
import { moved } from "../scene/shapes.js";
import { BRUSHES } from "./toolbox.js";

const ZOOM = 1.25;
const BRUSH = 1.2;
/** @type {Record<string, [number, number]>} */
const NUDGES = { left: [-1, 0], right: [1, 0], up: [0, -1], down: [0, 1] };

export class Commands {
  /** @param {Editor} editor */
  constructor(editor) {
    this.editor = editor;
  }

  /**
   * @param {string} id
   * @param {boolean} broad  with Shift: in larger steps
   * @returns {boolean} whether there is such an action here
   */
  run(id, broad = false) {
    const { editor } = this;
    if (editor.tools.has(id)) this.choose(id);
    else if (id in NUDGES) return this.#nudge(NUDGES[id], broad ? 10 : 1);
    else if (id in this.#table) this.#table[id]();
    else return false;
    return true;
  }

  /** @type {Record<string, () => void>} */
  get #table() {
    const { editor } = this;
    const { store, stage, live } = editor;
    return {
      undo: () => this.#settled(() => store.undo()),
      redo: () => this.#settled(() => store.redo()),
      duplicate: () => this.#duplicate(),
      delete: () => this.#delete(),
      fit: () => stage.fit(),
      "page-back": () => stage.turn(-1),
      "page-on": () => stage.turn(1),
      "zoom-in": () => stage.zoom(ZOOM),
      "zoom-out": () => stage.zoom(1 / ZOOM),
      mesh: () => this.#flip("mesh"),
      items: () => this.#flip("items"),
      panel: () => this.#flip("panel"),
      expand: () => (editor.dialog.open ? editor.dialog.close() : this.expand()),
      "brush-smaller": () => this.setBrush(editor.brushRadius / BRUSH),
      "brush-larger": () => this.setBrush(editor.brushRadius * BRUSH),
      "frame-back": () => this.seek(Math.floor(live.playback.position) - 1),
      "frame-on": () => this.seek(Math.floor(live.playback.position) + 1),
      hold: () => this.#holdAll(),
      play: () => this.#play(),
      loop: () => {
        live.playback.looping = !live.playback.looping;
        editor.redraw();
      },
      finish: () => editor.tool.finish(),
      cancel: () => this.#cancel(),
    };
  }

  /** @param {string} id of a tool */
  choose(id) {
    const { editor } = this;
    editor.tool.cancel();
    editor.replacing = null;
    editor.tool = /** @type {import("../stage/tool.js").Tool} */ (editor.tools.get(id));
    editor.stage.keys.style.cursor = editor.tool.cursor;
    // A brush chosen anew begins a new area, unless what is selected was painted.
    if (BRUSHES.includes(id) && itemAt(editor.document, editor.selection)?.region?.type !== "mask") editor.select(null);
    editor.show();
  }

  /** @param {"circle" | "polygon" | "brush"} kind of the region that the selected rig point is to have */
  redrawRegion(kind) {
    const { editor } = this;
    const waiting = editor.selection;
    const id = `region-${kind}`;
    editor.tool.cancel();
    editor.tool = /** @type {import("../stage/tool.js").Tool} */ (editor.tools.get(id));
    editor.replacing = waiting;
    editor.say(kind === "brush" ? say("Paint the region.") : say("Draw the region."));
    editor.show();
  }

  /** @param {number} radius [px] */
  setBrush(radius) {
    const { editor } = this;
    editor.brushRadius = Math.min(Math.max(Math.round(radius), 1), sideOf(editor.document));
    editor.show();
  }

  /** @param {import("../scene/layers.js").Layer} layer to be seen or not, which changes nothing in the scene */
  look(layer) {
    const { editor } = this;
    const { unseen } = editor.live.player;
    if (!unseen.delete(layer.index)) unseen.add(layer.index);
    editor.show();
  }

  /**
   * @param {import("../scene/layers.js").Layer} layer
   * @param {boolean} moves
   */
  move(layer, moves) {
    const { editor } = this;
    editor.commit(withMoves(editor.document, layer, moves, editor.layerList.layers));
    editor.choose(layer.name);
  }

  /**
   * @param {import("../scene/layers.js").Layer} layer
   * @param {string} preset
   */
  make(layer, preset) {
    const { editor } = this;
    editor.commit(withPreset(editor.document, layer, preset, editor.layerList.layers));
    editor.choose(layer.name);
  }

  /**
   * @param {import("../scene/layers.js").Layer} layer
   * @param {number} places  further to the front; below 0 to the back
   */
  place(layer, places) {
    const { editor } = this;
    editor.commit(withPlace(editor.document, layer, places, editor.layerList.layers));
    editor.choose(layer.name);
  }

  /**
   * @param {import("../scene/layers.js").Layer} layer
   * @param {string} attach  where it is to be held
   */
  async attach(layer, attach) {
    const { editor } = this;
    const { layers } = editor.layerList;
    const key = editor.live.run?.key;
    try {
      // Of a layer that does not move yet the next run finds where it is held.
      const holds = key && layer.moving && attach !== "none" ? await editor.live.client.holds(key, attach) : [];
      const points = attach === "none" ? [] : (holds.find((hold) => hold.name === layer.name)?.points ?? null);
      editor.commit(withAttach(editor.document, layer, attach, points, layers));
      editor.choose(layer.name);
    } catch (error) {
      editor.backdrop.trouble(/** @type {Error} */ (error));
    }
  }

  /** Hold every body where it is found to be held, or where the document says, and nowhere else. */
  async #holdAll() {
    const { editor } = this;
    const key = editor.live.run?.key;
    if (!key) return editor.backdrop.offerRun(say("Where the bodies are held is known once this node has run."));
    try {
      const sides = new Map([["found", await editor.live.client.holds(key, "found")]]);
      const holds = [];
      let { document } = editor;
      for (const found of sides.get("found") ?? []) {
        const said = document.bodies?.find((/** @type {any} */ body) => found.name && body.name === found.name)?.attach;
        if (said === "none") document = withOfBody(document, found.name, { attach: undefined });
        const side = said && said !== "none" ? said : "found";
        if (!sides.has(side)) sides.set(side, await editor.live.client.holds(key, side));
        holds.push(sides.get(side)?.find((hold) => hold.body === found.body) ?? found);
      }
      editor.commit(withHoldsAnew(document, holds, editor.layerList.layers), null);
      editor.say(say("All bodies are held where they are found to be held."));
    } catch (error) {
      editor.backdrop.trouble(/** @type {Error} */ (error));
    }
  }

  /** @param {number} frame */
  seek(frame) {
    this.editor.live.playback.seek(frame);
    this.editor.redraw();
  }

  /** @param {number} frames of the preview */
  setLength(frames) {
    const { editor } = this;
    editor.options.picks?.setLength(frames);
    editor.frames = frames;
    editor.show();
    editor.simulate();
  }

  /**
   * @param {import("../scene/document.js").Reference} reference
   * @param {import("../scene/document.js").Item} item  acting at other times
   * @param {boolean} done  whether it is a step to undo
   */
  retime(reference, item, done) {
    const { editor } = this;
    const document = withItem(editor.document, reference, item);
    if (done) editor.commit(document, reference);
    else editor.propose(document);
  }

  expand() {
    const { editor } = this;
    editor.dialog.append(editor.frame);
    editor.dialog.showModal();
    editor.stage.moved();
    editor.stage.focus();
    editor.show();
  }

  shrink() {
    const { editor } = this;
    editor.dialog.before(editor.frame);
    editor.stage.moved();
    editor.show();
  }

  #play() {
    const { live } = this.editor;
    if (!live.playback.moving) return;
    live.playback.toggle();
    live.playback.moment = performance.now();
    this.editor.redraw();
  }

  /** @param {"mesh" | "items" | "panel"} name */
  #flip(name) {
    this.editor.shown[name] = !this.editor.shown[name];
    this.editor.show();
  }

  /** @param {() => void} step */
  #settled(step) {
    this.editor.tool.cancel();
    this.editor.replacing = null;
    step();
  }

  #cancel() {
    const { editor } = this;
    const drawing = editor.tool.draft || editor.replacing;
    editor.tool.cancel();
    if (drawing) editor.replacing = null;
    else if (editor.selection) editor.select(null);
    else if (editor.chosen) editor.choose("");
    else if (editor.dialog.open) editor.dialog.close();
    editor.show();
  }

  #delete() {
    const { editor } = this;
    if (editor.selection) editor.commit(withoutItems(editor.document, [editor.selection]), null);
  }

  #duplicate() {
    const { editor } = this;
    const item = itemAt(editor.document, editor.selection);
    if (!item || !editor.selection) return;
    const step = Math.round(sideOf(editor.document) * 0.02);
    this.add(editor.selection.list, moved(editor.document, item, step, step));
  }

  /**
   * @param {string} list
   * @param {import("../scene/document.js").Item} item
   */
  add(list, item) {
    const { document, reference } = withAdded(this.editor.document, list, item);
    this.editor.commit(document, reference);
  }

  /**
   * @param {[number, number]} direction
   * @param {number} step  [px]
   */
  #nudge([dx, dy], step) {
    const { editor } = this;
    const item = itemAt(editor.document, editor.selection);
    if (!item || !editor.selection) return false;
    const there = moved(editor.document, item, dx * step, dy * step);
    const { list, index } = editor.selection;
    editor.commit(withItem(editor.document, editor.selection, there), editor.selection, `nudge ${list} ${index}`);
    return true;
  }
}
