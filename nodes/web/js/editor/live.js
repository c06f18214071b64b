/**
 * Live physics: keeps the motion of the scene up to date and shows it.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../preview/records.js").Mesh} Mesh
 * @typedef {import("../preview/records.js").PreviewRecord} PreviewRecord
 *
 * @typedef {object} Run  what a run of the node has left on the server
 * @property {string} key
 * @property {number} width  of the picture [px]
 * @property {number} height
 * @property {string | null} image  URL of the picture; null where none is connected
 * @property {string} plate  URL of what is behind the bodies
 *
 * @typedef {object} LiveListener
 * @property {() => void} redraw
 * @property {(error: Error | null) => void} trouble
 * @property {() => void} started  the first frame has come
 * @property {() => void} moved  the first frame in which something moves is on the screen
 */

import { PreviewClient } from "../preview/client.js";
import { MOVES, mark } from "../preview/marks.js";
import { Playback } from "../preview/playback.js";
import { Player } from "../preview/player.js";

export class Live {
  /**
   * @param {HTMLCanvasElement} film
   * @param {import("../preview/client.js").Fetch} fetch
   * @param {LiveListener} listener
   */
  constructor(film, fetch, listener) {
    this.player = new Player(film);
    this.playback = new Playback();
    this.listener = listener;
    const editor = crypto.randomUUID?.() ?? String(Math.random());
    this.client = new PreviewClient({ fetch, editor, onRecord: (record) => this.#take(record), onError: (error) => this.#fail(error) });
    /** @type {Run | null} */
    this.run = null;
    /** @type {Mesh | null} */
    this.mesh = null;
    /** What was measured of the last request, for the tests [ms, px]. */
    this.measured = { asked: 0, firstFrame: 0, drawn: 0, frames: 0, largest: 0 };
  }

  /**
   * @param {Run | null} run
   * @param {HTMLImageElement | null} picture
   */
  async setRun(run, picture) {
    this.client.cancel();
    this.playback.clear();
    this.player.unload();
    this.mesh = null;
    this.run = run;
    if (!run) return;
    try {
      const mesh = await this.client.mesh(run.key);
      if (this.run !== run) return;
      this.mesh = mesh;
      if (picture) this.player.load(mesh, picture, picture);
      this.listener.redraw();
    } catch (error) {
      if (this.run === run) this.#fail(/** @type {Error} */ (error));
    }
  }

  /**
   * @param {Run} run
   * @param {HTMLImageElement} plate
   */
  setPlate(run, plate) {
    if (this.run !== run || !this.player.mesh) return;
    this.player.load(this.player.mesh, /** @type {TexImageSource} */ (this.player.picture), plate);
    this.listener.redraw();
  }

  /**
   * @param {SceneDocument} document
   * @param {number} frames
   */
  request(document, frames) {
    if (!this.run || !this.mesh) return;
    this.measured = { asked: performance.now(), firstFrame: 0, drawn: 0, frames: 0, largest: 0 };
    this.playback.waiting = true;
    this.client.request(this.run.key, document, frames);
  }

  /** @param {PreviewRecord} record */
  #take(record) {
    if (record.type === "header") {
      const fits = record.header.vertices * 2 === this.mesh?.positions.length;
      if (fits) this.playback.begin(record.header, performance.now());
      this.listener.trouble(fits ? null : new Error("The bodies have changed: run the node again."));
    } else if (record.type === "frame" && this.playback.header) {
      this.playback.add(record.frame);
      this.measured.frames += 1;
      if (this.measured.frames === 2) this.measured.firstFrame = performance.now() - this.measured.asked;
      if (this.measured.frames === 1) this.listener.started();
      this.listener.redraw();
    } else if (record.type === "end") this.measured.largest = record.end.largest_displacement;
    else if (record.type === "error") this.#fail(new Error(record.error));
  }

  /** @param {Error} error */
  #fail(error) {
    this.playback.clear();
    this.listener.trouble(error);
    this.listener.redraw();
  }

  /** Whether the moving mesh can be shown in place of the picture. */
  get shows() {
    return Boolean(this.player.ready && this.player.mesh && this.playback.shown);
  }

  get unit() {
    return this.playback.header?.unit ?? 1;
  }

  /**
   * @param {import("../scene/geometry.js").View} view
   * @param {number} across  of the stage [CSS px]
   * @param {number} down
   * @param {boolean} meshShown  its edges too
   */
  draw(view, across, down, meshShown) {
    const frame = this.playback.shown;
    if (!this.shows || !frame) {
      this.player.clear();
      return;
    }
    this.player.draw(view, across, down, frame.displacements, this.unit, meshShown);
    // The motion before this request goes on until the new one comes, and does not count.
    if (frame.number && this.measured.frames > 1 && !this.measured.drawn) {
      this.measured.drawn = performance.now() - this.measured.asked;
      mark(MOVES);
      this.listener.moved();
    }
  }

  release() {
    this.client.cancel();
    this.player.release();
  }
}
