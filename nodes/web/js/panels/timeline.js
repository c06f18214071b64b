/**
 * The time below the picture: play, pause, loop, and when each item acts.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../preview/playback.js").Playback} Playback
 *
 * @typedef {object} TimelineListener
 * @property {() => void} toggle
 * @property {() => void} loop
 * @property {(frame: number) => void} seek
 * @property {(frames: number) => void} length
 * @property {(reference: Reference) => void} select
 * @property {(reference: Reference, item: Item, done: boolean) => void} retime  an item acts at other times
 */

import { allItems } from "../scene/document.js";
import { titleOf } from "../scene/items.js";
import { departures, edgesOf, spansOf, withEdge } from "../scene/timing.js";
import { colourOf } from "../stage/colours.js";
import { element } from "./elements.js";
import { icon } from "./icons.js";

const MOST_FRAMES = 2400;
const MOST_LANES = 60;

export class Timeline {
  /** @param {TimelineListener} listener */
  constructor(listener) {
    this.listener = listener;
    this.play = element("button", { type: "button", "data-action": "play", onclick: listener.toggle });
    this.loop = element("button", { type: "button", innerHTML: icon("loop"), title: "Play again and again", "aria-label": "Play again and again", "data-action": "loop", onclick: listener.loop });
    this.slider = element("input", { type: "range", min: "0", step: "1", "aria-label": "Frame", className: "physanimator-slider", oninput: () => listener.seek(Number(this.slider.value)) });
    this.readout = element("span", { className: "physanimator-readout", "aria-live": "off" });
    this.length = element("input", { type: "number", min: "2", max: String(MOST_FRAMES), step: "1", title: "Length of the preview [frames]", "aria-label": "Length of the preview [frames]", className: "physanimator-length", onchange: () => this.#setLength() });
    this.lanes = element("div", { className: "physanimator-lanes" });
    const bar = element("div", { className: "physanimator-bar" }, [this.play, this.loop, this.slider, this.readout, this.length]);
    this.root = element("div", { className: "physanimator-timeline" }, [bar, this.lanes]);
    this.shown = "";
    this.duration = 1;
    /** @type {{reference: Reference, item: Item, edge: import("../scene/timing.js").Edge, changed: Item} | null} */
    this.dragged = null;
    this.#listen();
  }

  /** The lanes listen, because each lane is made anew while its item changes. */
  #listen() {
    this.lanes.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => this.#drag(event));
    this.lanes.addEventListener("pointerup", () => this.#drop(true));
    this.lanes.addEventListener("pointercancel", () => this.#drop(false));
  }

  /**
   * @param {PointerEvent} event
   * @param {Reference} reference
   * @param {Item} item
   * @param {import("../scene/timing.js").Edge} edge
   */
  #grasp(event, reference, item, edge) {
    if (event.button !== 0) return;
    event.preventDefault();
    this.lanes.setPointerCapture(event.pointerId);
    this.dragged = { reference, item, edge, changed: item };
    this.listener.select(reference);
  }

  /** @param {PointerEvent} event */
  #drag(event) {
    const { dragged } = this;
    if (!dragged) return;
    const box = this.lanes.getBoundingClientRect();
    const time = ((event.clientX - box.left) / box.width) * this.duration;
    dragged.changed = withEdge(dragged.reference, dragged.item, dragged.edge, time, this.duration);
    this.listener.retime(dragged.reference, dragged.changed, false);
  }

  /** @param {boolean} keep */
  #drop(keep) {
    const { dragged } = this;
    this.dragged = null;
    if (!dragged || dragged.changed === dragged.item) return;
    this.listener.retime(dragged.reference, keep ? dragged.changed : dragged.item, keep);
  }

  #setLength() {
    const frames = Math.round(Number(this.length.value));
    if (frames >= 2 && frames <= MOST_FRAMES) this.listener.length(frames);
    else this.length.value = this.slider.max;
  }

  /** @param {Playback} playback */
  showPosition(playback) {
    const frame = Math.floor(playback.position);
    const state = `${playback.playing} ${playback.looping} ${frame} ${playback.duration} ${playback.frameRate}`;
    if (state === this.shown) return;
    this.shown = state;
    const title = playback.playing ? "Pause (Space)" : "Play (Space)";
    this.play.innerHTML = icon(playback.playing ? "pause" : "play");
    this.play.title = title;
    this.play.setAttribute("aria-label", title);
    this.loop.setAttribute("aria-pressed", String(playback.looping));
    this.slider.max = String(playback.duration - 1);
    this.slider.value = String(frame);
    this.readout.textContent = `${frame} · ${(frame / playback.frameRate).toFixed(2)} s`;
    if (globalThis.document.activeElement !== this.length) this.length.value = String(playback.duration);
    this.lanes.style.setProperty("--physanimator-now", String(frame / Math.max(playback.duration - 1, 1)));
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} selection
   * @param {number} duration  [s]
   */
  showItems(document, selection, duration) {
    this.duration = duration;
    const items = allItems(document).filter(({ reference }) => reference.list !== "query_points");
    const lanes = items.slice(0, MOST_LANES).map(({ reference, item }) => {
      const lane = element("div", {
        className: "physanimator-lane",
        title: titleOf(reference, item),
        "data-selected": String(selection?.list === reference.list && selection.index === reference.index),
        onclick: () => this.listener.select(reference),
      });
      lane.style.setProperty("--physanimator-colour", colourOf(reference.list, item));
      const spans = spansOf(reference, item, duration).map(([from, to]) => this.#piece("physanimator-span", from, to, duration));
      const ticks = reference.list === "strokes" ? departures(item, duration).slice(0, 200) : [];
      const edges = edgesOf(reference, item, duration).map(([edge, time]) => {
        const grip = this.#piece("physanimator-edge", time, time, duration);
        grip.dataset.edge = edge;
        grip.title = `${titleOf(reference, item)}: drag its ${edge}`;
        grip.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => this.#grasp(event, reference, item, edge));
        return grip;
      });
      lane.append(...spans, ...ticks.map((time) => this.#piece("physanimator-tick", time, time, duration)), ...edges);
      return lane;
    });
    const empty = lanes.length ? [] : [element("div", { className: "physanimator-empty" }, ["What you draw appears here, with the times at which it acts."])];
    this.lanes.replaceChildren(...lanes, ...empty, element("div", { className: "physanimator-now" }));
  }

  /**
   * @param {string} name
   * @param {number} from  [s]
   * @param {number} to
   * @param {number} duration
   */
  #piece(name, from, to, duration) {
    const piece = element("div", { className: name });
    piece.style.left = `${(100 * from) / duration}%`;
    if (to > from) piece.style.width = `${(100 * (to - from)) / duration}%`;
    return piece;
  }
}
