/**
 * Picking parts: the cut under the clicks and, where the node animates, the motion of what is cut. Both come from the
 * server, which cuts as the nodes do; the newest click wins.
 *
 * @typedef {import("./editor.js").Editor} Editor
 *
 * @typedef {object} PickOptions  what the picker needs of its node
 * @property {() => Source | null} source  the picture to cut; null where the server does not know it, or nothing can be cut
 * @property {() => Record<string, any> | null} cleaning  what is done to the masks; null where another segmenter cuts
 * @property {(() => Record<string, any>) | null} move  how parts move; null where the node only cuts
 * @property {(path: string) => string} url  of a path on the server
 * @property {string[]} presets  to choose from for each part; none where parts have none
 * @property {(() => void) | null} choosePicture  asks for a file; null where the node has no picture of its own
 * @property {((file: File) => void) | null} takePicture  one was dropped or pasted
 * @property {(frames: number) => void} setLength  of the motion
 * @property {(picture: boolean, named: number | null) => string} hint  what to do while nothing is picked; ``named``: how
 *   many layers move by their names, null where that is not known
 *
 * @typedef {{picture: string | null, alpha: boolean, layered?: boolean}} Source  a file of the host's folders, which may be in layers; null for the example
 * @typedef {{part: number, fill: HTMLCanvasElement, edge: HTMLCanvasElement}} Cut  part is negative where a layer moves by its name
 */

import { say } from "../host/words.js";
import { element } from "../panels/elements.js";
import { PartsStrip } from "../panels/parts_strip.js";
import { failed, Refusal, Unanswered } from "../preview/client.js";
import { isLong } from "../scene/geometry.js";
import { partCount, pointsOn, presetOf, withoutPart, withPartPreset } from "../scene/parts.js";
import { partColour } from "../stage/colours.js";
import { regionEdge, regionMask } from "../stage/tints.js";
import { loaded } from "./pictures.js";

/** Changes that follow within this time belong together [ms]. */
const PAUSE = 120;
/** Work that takes longer than this is told of [ms]. */
const LONG = 250;

const STYLE = `
.physanimator-result { position: absolute; inset: 0; display: flex; align-items: center; justify-content: center; background: var(--physanimator-field); }
.physanimator-result[hidden] { display: none; }
/* Older Vue canvases show a node's output below it whatever it says, and take films for pictures. */
[data-node-id]:has(.physanimator-editor[data-picks="true"]) :is(.image-preview, .video-preview) { display: none; }
.physanimator-result > * { width: 100%; height: 100%; object-fit: contain; }
/* Long pages go on beyond the stage, as in the picture. */
.physanimator-result[data-long] { display: block; overflow: auto; scrollbar-width: thin; }
.physanimator-result[data-long="down"] > * { display: block; width: min(100%, 100cqh); height: auto; margin: 0 auto; }
.physanimator-result[data-long="across"] > * { width: auto; height: min(100%, 100cqw); max-width: none; }
.physanimator-editor[data-picks] .physanimator-dialog .physanimator-frame {
  grid-template: "toolbar toolbar toolbar" auto "tools parts corner" auto "tools stage stage" minmax(0, 1fr) "tools status status" auto "timeline timeline timeline" auto / auto minmax(0, 1fr) auto;
}
.physanimator-dialog .physanimator-parts { grid-area: parts; padding: 6px 8px; }
.physanimator-dialog .physanimator-parts-corner { grid-area: corner; align-self: start; padding: 6px 8px; }
.physanimator-editor[data-picks="true"] .physanimator-lanes { display: none; }
.physanimator-frame[data-viewed="result"] .physanimator-bar :is(button, .physanimator-slider, .physanimator-readout) { visibility: hidden; }
.physanimator-editor[data-picks="true"] { min-height: 330px; }
/* What such a node has beside its editor in older Vue canvases: with less the node would grow each time it is opened. */
[data-node-id] .physanimator-editor[data-picks] { min-height: max(300px, var(--node-height, 0px) - 276px); }
[data-node-id] .physanimator-editor[data-picks="true"] { min-height: max(400px, var(--node-height, 0px) - 472px); }
`;

export class Picking {
  /**
   * @param {Editor} editor
   * @param {PickOptions} options
   */
  constructor(editor, options) {
    this.editor = editor;
    this.options = options;
    /** Part to which a click adds. */
    this.part = 0;
    /** @type {Cut[] | null} */
    this.cuts = null;
    /** @type {AbortController | null} */
    this.running = null;
    /** @type {any} */
    this.timer = 0;
    this.asked = { cut: "", all: "" };
    /** @type {number | null} layers that move by their names; null where that is not known */
    this.named = null;
    this.viewed = false;
    /** What was measured of the last change, for the tests [ms]. */
    this.measured = { asked: 0, cut: 0, moving: 0 };
    this.strip = new PartsStrip(
      {
        picture: () => options.choosePicture?.(),
        choose: (part) => this.choose(part),
        more: () => this.more(),
        make: (part, preset) => editor.commit(withPartPreset(editor.document, part, preset)),
        remove: (part) => this.remove(part),
        view: (result) => this.view(result),
      },
      { presets: options.presets, picture: options.choosePicture !== null },
    );
    /** @type {HTMLElement} */
    this.result = element("div", { className: "physanimator-result", hidden: true, title: say("Click to go on picking"), onclick: () => this.view(false) });
  }

  /** Put what is shown into the editor's parts of the page. */
  mount() {
    const { editor } = this;
    editor.root.dataset.picks = String(this.options.move !== null);
    editor.toolbar.root.append(element("style", { textContent: STYLE }), this.strip.corner, this.strip.root);
    editor.stage.root.append(this.result);
  }

  // Parts.

  get count() {
    return partCount(this.editor.document, this.part);
  }

  /** @param {number} part */
  choose(part) {
    this.part = part;
    if (!["query-positive", "query-negative"].includes(this.editor.tool.id)) this.editor.commands.choose("query-positive");
    this.editor.show();
  }

  /** The next click begins another part, unless the last one has no point yet. */
  more() {
    const last = partCount(this.editor.document) - 1;
    this.choose(pointsOn(this.editor.document, last) ? last + 1 : last);
  }

  /** @param {number} part */
  remove(part) {
    const { editor } = this;
    if (this.part >= part) this.part = Math.max(0, this.part - 1);
    editor.commit(withoutPart(editor.document, part), null);
  }

  /** Nothing is picked on a new picture. */
  anew() {
    const { editor } = this;
    this.part = 0;
    if (editor.document.query_points?.length) editor.commit({ ...editor.document, query_points: [], bodies: [] }, null);
  }

  /** Bring the strip up to date. */
  show() {
    const { document, backdrop, notes } = this.editor;
    notes.keep("empty", document.query_points?.length ? "" : this.options.hint(backdrop.picture !== null, this.named));
    const parts = Array.from({ length: this.count }, (_, part) => part);
    this.strip.show({
      count: this.count,
      current: this.part,
      points: parts.map((part) => pointsOn(document, part)),
      presets: parts.map((part) => presetOf(document, part)),
      result: this.result.childElementCount > 0,
      viewed: this.viewed,
    });
  }

  // The result of a run.

  /** @param {string} url @param {boolean} video */
  takeResult(url, video) {
    const shown = video
      ? element("video", { src: url, autoplay: true, loop: true, muted: true, playsInline: true })
      : element("img", { src: url, alt: say("The frames of the last run"), draggable: false });
    this.result.replaceChildren(shown);
    const { width, height } = this.editor.document;
    const { stage } = this.editor;
    const long = isLong(width, height, stage.across, stage.down);
    if (long) this.result.dataset.long = width > height ? "across" : "down";
    else delete this.result.dataset.long;
    this.view(true);
  }

  /** @param {boolean} result  look at the frames of the last run, not at the picture */
  view(result) {
    this.viewed = result && this.result.childElementCount > 0;
    this.result.hidden = !this.viewed;
    // The bar below plays the preview, which is not what is seen then.
    this.editor.frame.dataset.viewed = this.viewed ? "result" : "picking";
    const film = /** @type {any} */ (this.result.firstElementChild);
    if (this.viewed) film?.play?.()?.catch?.(() => null);
    else film?.pause?.();
    this.show();
    this.editor.redraw();
  }

  // Cut and motion.

  /** Ask anew if anything on which the cut or the motion depends is another than at the last time. */
  changed() {
    this.show();
    const wanted = this.#wanted();
    const key = { cut: JSON.stringify({ ...wanted, move: null }), all: JSON.stringify(wanted) };
    if (key.all === this.asked.all) return;
    const again = key.cut === this.asked.cut && this.cuts !== null;
    this.asked = key;
    this.#stop();
    if (this.viewed) this.view(false);
    if (!again) this.#forget();
    if (!wanted) this.named = null;
    if (!wanted) return this.show();
    this.measured = { asked: performance.now(), cut: 0, moving: 0 };
    this.timer = setTimeout(() => this.#ask(wanted, again), PAUSE);
  }

  /** The server has forgotten the bodies: make them again. */
  renew() {
    this.asked = { cut: "", all: "" };
    this.changed();
  }

  release() {
    this.#stop();
  }

  /** What the server is to be asked for; null for nothing. */
  #wanted() {
    const { document, backdrop, live } = this.editor;
    const source = this.options.source();
    const cleaning = this.options.cleaning();
    const points = document.query_points ?? [];
    const picks = points.some((/** @type {any} */ point) => point.positive !== false) || Boolean(cleaning?.box?.trim());
    if (!source || !cleaning || !backdrop.picture) return null;
    const { layered, ...file } = source;
    if (!picks && !layered) return null;
    const { width, height, bodies, version } = document;
    const asked = { version, width, height, query_points: points, ...(bodies ? { bodies } : {}) };
    return { editor: live.client.editor, ...file, points: asked, cleaning, move: this.options.move?.() ?? null };
  }

  /**
   * @param {any} wanted
   * @param {boolean} again  whether the cut is known
   */
  async #ask(wanted, again) {
    const mine = new AbortController();
    const { editor } = this;
    this.running = mine;
    const telling = setTimeout(() => this.running === mine && this.#tell(wanted.move && this.cuts ? say("Preparing the motion…") : say("Cutting it out…")), LONG);
    try {
      if (!again) {
        this.#take(await this.#post({ ...wanted, move: null }, mine));
        editor.backdrop.trouble(null);
        if (wanted.move && !this.viewed) this.#tell(say("Preparing the motion…"));
      }
      if (wanted.move && this.cuts?.length) {
        const moving = await this.#post(wanted, mine);
        // What is too small to move is cut all the same, and the advice says so.
        if (moving.key) await this.#move(moving, mine);
      }
      if (this.running === mine) this.#tell("");
    } catch (error) {
      if (this.running !== mine || mine.signal.aborted) return;
      this.#tell("");
      if (error instanceof Unanswered) editor.backdrop.trouble(error);
      else editor.notes.show("pick", /** @type {Error} */ (error).message, { kind: "error", closes: true });
    } finally {
      clearTimeout(telling);
    }
  }

  /**
   * @param {any} body
   * @param {AbortController} mine
   */
  async #post(body, mine) {
    const answer = await this.editor.options.fetch("/physanimator/pick", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
      signal: mine.signal,
    }).catch(failed);
    const said = await answer.json().catch(() => null);
    if (this.running !== mine) throw new Refusal("", 0);
    if (!answer.ok) throw new Refusal(said?.error ?? say("The server answered {status}.", { status: `${answer.status} ${answer.statusText}` }), answer.status);
    return said;
  }

  /** @param {{cuts: any[], advice: string[]}} answer */
  #take({ cuts, advice }) {
    this.named = cuts.filter((cut) => cut.part < 0).length;
    this.cuts = cuts.map((cut) => {
      const colour = partColour(cut.part);
      return { part: cut.part, fill: regionMask(cut, colour), edge: regionEdge(cut, colour) };
    });
    this.measured.cut = performance.now() - this.measured.asked;
    this.editor.advise(advice);
    this.show();
    this.editor.redraw();
  }

  /**
   * @param {any} answer
   * @param {AbortController} mine
   */
  async #move({ key, scene, frames, width, height, drawn = null }, mine) {
    const { editor } = this;
    const { live } = editor;
    if (live.run?.key !== key) {
      const layers = drawn && { layers: [], drawn: drawn.map((/** @type {any} */ one, /** @type {number} */ number) => ({ ...one, url: this.options.url(`/physanimator/layer/${key}/${number}`) })) };
      const run = { key, width, height, image: null, plate: this.options.url(`/physanimator/plate/${key}`), layers, materials: null, holds: [] };
      await live.setRun(run, editor.backdrop.picture);
      if (this.running !== mine) return;
      // Made when first asked for, which takes a moment; until then the picture itself is behind the parts.
      if (!layers) loaded(run.plate).then((plate) => live.setPlate(run, plate)).catch(() => null);
    }
    editor.frames = frames;
    live.request(scene, frames);
    this.measured.moving = performance.now() - this.measured.asked;
    editor.show();
  }

  #forget() {
    this.cuts = null;
    this.editor.live.setRun(null, null);
    this.editor.redraw();
  }

  #stop() {
    clearTimeout(this.timer);
    this.running?.abort();
    this.running = null;
    this.editor.live.client.cancel();
    this.#tell("");
  }

  /** @param {string} sentence */
  #tell(sentence) {
    this.editor.notes.show("pick", sentence);
  }
}
