/**
 * What the scene is drawn on: a picture from the graph or from a run, and the bodies that the run has left.
 *
 * @typedef {import("./editor.js").Editor} Editor
 * @typedef {import("./live.js").Run} Run
 */

import { say } from "../host/words.js";
import { hasItems } from "../scene/document.js";
import { rescaled } from "../scene/rescaling.js";
import { loaded } from "./pictures.js";

export class Backdrop {
  /** @param {Editor} editor */
  constructor(editor) {
    this.editor = editor;
    /** @type {HTMLImageElement | null} */
    this.picture = null;
    /** @type {string | null} */
    this.wanted = null;
    /** Whether a run has been asked for here that has not come. */
    this.waiting = false;
    /** How many runs are being taken up: their bodies come last. */
    this.arriving = 0;
  }

  /** @param {string} url of a picture to draw on */
  async setPicture(url) {
    this.wanted = url;
    try {
      const picture = await loaded(url);
      if (this.wanted === url) this.#take(picture);
    } catch (error) {
      if (this.wanted === url) this.editor.say(/** @type {Error} */ (error).message);
    }
  }

  /** @param {Run} run */
  async setRun(run) {
    const { editor } = this;
    this.waiting = false;
    this.arriving += 1;
    if (!editor.live.playback.moving) this.prepare();
    try {
      await this.#takeRun(run);
    } finally {
      this.arriving -= 1;
    }
    editor.simulate();
    if (run.layers) return;
    // Made when first asked for, which takes a moment; until then the picture itself is behind the bodies.
    const plate = await loaded(run.plate).catch(() => null);
    if (plate) editor.live.setPlate(run, plate);
  }

  /** @param {Run} run whose picture, layers and holds the editor takes before its bodies */
  async #takeRun(run) {
    const { editor } = this;
    if (run.layers && !run.image) this.picture = null;
    const picture = run.image ? await loaded(run.image) : this.picture;
    if (run.image) this.wanted = null;
    editor.setMaterials(run.materials);
    editor.setLayers(run.layers?.layers ?? []);
    if (picture) this.#take(picture);
    else this.fitTo(run.width, run.height);
    editor.takeHolds(run.holds);
    await editor.live.setRun(run, picture);
  }

  /** Nothing is known of the bodies any more, such as when another picture is chosen. */
  forgetRun() {
    this.editor.live.setRun(null, null);
    this.offerRun();
    this.editor.redraw();
  }

  /** The node has run, and the motion is on its way. */
  prepare() {
    const { notes, options } = this.editor;
    if (options.moves) notes.show("run", say("Preparing the motion…"));
  }

  /** The node has been asked to run, and has not yet. */
  wait() {
    const { notes, options } = this.editor;
    this.waiting = true;
    if (options.moves) notes.show("run", say("This node is running…"));
  }

  /** A run has ended; what it has not brought is offered again. */
  stopWaiting() {
    if (!this.waiting) return;
    this.waiting = false;
    this.offerRun();
  }

  /** There is no picture any more. */
  forgetPicture() {
    this.picture = this.wanted = null;
    this.editor.show();
  }

  /** @param {string} reason why nothing moves */
  offerRun(reason = say("Nothing moves yet: the bodies are known once this node has run.")) {
    const { notes, options } = this.editor;
    if (options.moves && !options.picks && !this.waiting) notes.show("run", reason, { button: [say("Run this node"), options.onRun] });
  }

  /** @param {Error | null} error of the preview */
  trouble(error) {
    const gone = /** @type {any} */ (error)?.status === 404;
    this.editor.notes.show("motion", error && !gone ? error.message : "", { kind: "error" });
    if (error && !gone) this.editor.notes.show("run", "");
    if (gone) this.editor.picking?.renew();
    if (!gone || this.editor.picking) return;
    this.editor.live.setRun(null, null);
    this.offerRun(/** @type {Error} */ (error).message);
  }

  /** The server is there again: what could not be asked for is asked for now. */
  reconnected() {
    const { live, notes, picking } = this.editor;
    live.client.warm = false;
    if (!notes.shown.has("motion")) return;
    this.trouble(null);
    if (picking) return picking.renew();
    live.asked = "";
    this.editor.simulate();
  }

  /** Fit a scene that has just been read to the picture that is there. */
  refit() {
    if (this.picture) this.fitTo(this.picture.naturalWidth, this.picture.naturalHeight);
  }

  /**
   * The scene over a picture of another size: what is drawn is scaled along, once.
   *
   * @param {number} width  [px]
   * @param {number} height
   */
  fitTo(width, height) {
    const { editor } = this;
    const before = editor.document;
    if (before.width === width && before.height === height) return;
    // Points from a plain list are pixels of the picture, whatever its size.
    const after = before.sizeless ? { ...before, width, height, sizeless: undefined } : rescaled(before, width, height);
    if (hasItems(before) && !before.sizeless) {
      editor.commit(after, editor.selection);
      editor.say(
        say("The picture is {width} × {height} px now; what is drawn has been scaled along from {oldWidth} × {oldHeight} px.", {
          width,
          height,
          oldWidth: before.width,
          oldHeight: before.height,
        }),
      );
    } else editor.store.load(after);
    editor.resize(after);
  }

  /** @param {HTMLImageElement} picture */
  #take(picture) {
    this.picture = picture;
    this.refit();
    this.editor.redraw();
  }
}
