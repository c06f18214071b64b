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
 * @property {LayersOfRun | null} layers  null where masks cut the bodies out of a flat picture
 * @property {import("../scene/materials.js").Materials | null} materials
 * @property {import("../scene/holds.js").Hold[]} holds  pins that the run has found beside the document's own
 *
 * @typedef {object} LayersOfRun
 * @property {import("../scene/layers.js").Layer[]} layers  from front to back
 * @property {{layer: number, body: number | null, box: [number, number, number, number], blend: string, url: string}[]} drawn  from back to front
 *
 * @typedef {object} LiveListener
 * @property {() => void} redraw
 * @property {(error: Error | null) => void} trouble
 * @property {(bodies: number[]) => void} unheld  numbers of the bodies that nothing holds
 * @property {() => void} started  the first frame has come
 * @property {(end: any) => void} ended  the last one has come, with what is known of the whole
 * @property {() => void} moved  the first frame in which something moves is on the screen
 */

import { say } from "../host/words.js";
import { PreviewClient } from "../preview/client.js";
import { layerAt } from "../preview/layered_picture.js";
import { MOVES, mark } from "../preview/marks.js";
import { Playback } from "../preview/playback.js";
import { Player } from "../preview/player.js";
import { canonical } from "../scene/canonical.js";
import { loaded } from "./pictures.js";

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
    /** @type {{drawn: any, box: [number, number, number, number], mesh: Mesh | null, whole?: Mesh} | null} of one layer or body, made last */
    this.outlined = null;
    /** The last request, in one spelling; empty where its answer does not count any more. */
    this.asked = "";
    /** Displacements of a mesh at rest. */
    this.still = new Int16Array(0);
    /** What was measured of the last request, for the tests [ms, px]. */
    this.measured = { asked: 0, firstFrame: 0, drawn: 0, frames: 0, largest: 0 };
  }

  /**
   * @param {Run | null} run
   * @param {HTMLImageElement | null} picture
   */
  async setRun(run, picture) {
    if (run && this.mesh && run.key === this.run?.key) {
      this.run = run; // the very bodies that are here already
      return;
    }
    this.client.cancel();
    this.asked = "";
    this.playback.clear();
    this.player.unload();
    this.mesh = null;
    this.run = run;
    if (!run) this.listener.unheld([]);
    if (!run) return;
    try {
      const mesh = await this.client.mesh(run.key);
      if (this.run !== run) return;
      this.mesh = mesh;
      if (run.layers) await this.#loadLayers(run, mesh, run.layers.drawn);
      else if (picture) this.player.load(mesh, picture, picture);
      this.listener.redraw();
    } catch (error) {
      if (this.run === run) this.#fail(/** @type {Error} */ (error));
    }
  }

  /**
   * @param {Run} run
   * @param {Mesh} mesh
   * @param {LayersOfRun["drawn"]} drawn
   */
  async #loadLayers(run, mesh, drawn) {
    const layers = await Promise.all(drawn.map(async ({ url, ...rest }) => ({ ...rest, picture: await loaded(url) })));
    if (this.run === run) this.player.loadLayers(mesh, layers);
  }

  /** Show the picture at rest: what moves is not known at this moment. */
  hold() {
    this.client.cancel();
    this.asked = "";
    this.playback.clear();
    this.listener.redraw();
  }

  /**
   * The layer that moves at a point, in front of all others.
   *
   * @param {import("../scene/document.js").Point} point
   * @returns {number | null} its index in the artwork
   */
  layerAt(point) {
    const { mesh, player, playback } = this;
    if (!mesh || !player.layers.length) return null;
    return layerAt(mesh, player.stacked, player.unseen, point, playback.shown?.displacements ?? null, this.unit);
  }

  /**
   * The body at a point, in front of all others, where the picture is flat.
   *
   * @param {import("../scene/document.js").Point} point
   * @returns {number | null} its place from the back
   */
  bodyAt(point) {
    const { mesh, playback } = this;
    if (!mesh) return null;
    const bodies = Array.from({ length: mesh.bodies.length / 2 }, (_, body) => ({ layer: body, body }));
    return layerAt(mesh, bodies, new Set(), point, playback.shown?.displacements ?? null, this.unit);
  }

  /** @param {number} body  its place from the back; its mesh alone, to be drawn around it */
  outlineOfBody(body) {
    const { mesh } = this;
    if (!mesh || body < 0) return null;
    if (this.outlined?.drawn === body && this.outlined.whole === mesh) return this.outlined;
    const triangles = mesh.triangles.subarray(3 * mesh.bodies[2 * body], 3 * mesh.bodies[2 * body + 1]);
    this.outlined = { drawn: body, box: [0, 0, 0, 0], mesh: { ...mesh, triangles }, whole: mesh };
    return this.outlined;
  }

  /**
   * The mesh of one layer alone, and where its picture is; the same object as long as nothing changes.
   *
   * @param {number} layer  its index in the artwork
   */
  outlineOf(layer) {
    const { mesh } = this;
    const drawn = this.player.layers.find((one) => one.layer === layer);
    if (!mesh || !drawn) return null;
    if (this.outlined?.drawn === drawn) return this.outlined;
    const { body, box } = drawn;
    const triangles = body === null ? null : mesh.triangles.subarray(3 * mesh.bodies[2 * body], 3 * mesh.bodies[2 * body + 1]);
    this.outlined = { drawn, box, mesh: triangles && { ...mesh, triangles } };
    return this.outlined;
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
    const asked = canonical([this.run.key, document, frames]);
    if (asked === this.asked) return;
    this.asked = asked;
    this.measured = { asked: performance.now(), firstFrame: 0, drawn: 0, frames: 0, largest: 0 };
    this.playback.waiting = true;
    this.client.request(this.run.key, document, frames);
  }

  /** @param {PreviewRecord} record */
  #take(record) {
    if (record.type === "header") {
      const fits = record.header.vertices * 2 === this.mesh?.positions.length;
      if (fits) this.playback.begin(record.header, performance.now());
      this.listener.unheld(record.header.unheld ?? []);
      this.listener.trouble(fits ? null : new Error(say("The bodies have changed: run the node again.")));
    } else if (record.type === "frame" && this.playback.header) {
      this.playback.add(record.frame);
      this.measured.frames += 1;
      if (this.measured.frames === 2) this.measured.firstFrame = performance.now() - this.measured.asked;
      if (this.measured.frames === 1) this.listener.started();
      this.listener.redraw();
    } else if (record.type === "end") {
      this.measured.largest = record.end.largest_displacement;
      this.listener.ended(record.end);
    }
    else if (record.type === "error") this.#fail(new Error(record.error));
  }

  /** @param {Error} error */
  #fail(error) {
    this.asked = "";
    this.playback.clear();
    this.listener.trouble(error);
    this.listener.redraw();
  }

  /** Whether the moving mesh can be shown in place of the picture. */
  get shows() {
    const { player } = this;
    return Boolean(player.ready && player.mesh && (this.playback.shown || player.layered));
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
    if (!this.shows || !this.mesh) {
      this.player.clear();
      return;
    }
    this.player.draw(view, across, down, frame?.displacements ?? this.#rest(this.mesh), this.unit, meshShown);
    if (!frame) return;
    // The motion before this request goes on until the new one comes, and does not count.
    if (frame.number && this.measured.frames > 1 && !this.measured.drawn) {
      this.measured.drawn = performance.now() - this.measured.asked;
      mark(MOVES);
      this.listener.moved();
    }
  }

  /** @param {Mesh} mesh */
  #rest({ positions }) {
    if (this.still.length !== positions.length) this.still = new Int16Array(positions.length);
    return this.still;
  }

  release() {
    this.client.cancel();
    this.player.release();
  }
}
