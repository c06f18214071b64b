/**
 * The time below the picture: play, pause, loop, and when each item acts.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../preview/playback.js").Playback} Playback
 * @typedef {{reference: Reference, item: Item, duration: number, root: HTMLElement}} Lane  when one item acts
 *
 * @typedef {object} TimelineListener
 * @property {() => void} toggle
 * @property {() => void} loop
 * @property {(frame: number) => void} seek
 * @property {(frames: number) => void} length
 * @property {(reference: Reference) => void} select
 * @property {(reference: Reference, item: Item, done: boolean) => void} retime  an item acts at other times
 */

import { say } from "../host/words.js";
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
    this.loop = element("button", { type: "button", innerHTML: icon("loop"), title: say("Play again and again"), "aria-label": say("Play again and again"), "data-action": "loop", onclick: listener.loop });
    this.slider = element("input", { type: "range", min: "0", step: "1", "aria-label": say("Frame"), className: "physanimator-slider", oninput: () => listener.seek(Number(this.slider.value)) });
    this.readout = element("span", { className: "physanimator-readout", "aria-live": "off" }, [""]);
    this.length = element("input", { type: "number", min: "2", max: String(MOST_FRAMES), step: "1", title: say("Length of the preview [frames]"), "aria-label": say("Length of the preview [frames]"), className: "physanimator-length", onchange: () => this.#setLength() });
    this.lanes = element("div", { className: "physanimator-track" });
    this.now = element("div", { className: "physanimator-now" });
    // As broad as the lanes, beside their names.
    this.ruler = element("div", { className: "physanimator-ruler" }, [this.now]);
    const bar = element("div", { className: "physanimator-bar" }, [this.play, this.loop, this.slider, this.readout, this.length, element("span", { className: "physanimator-unit" }, [say("frames")])]);
    this.root = element("div", { className: "physanimator-timeline" }, [bar, element("div", { className: "physanimator-lanes" }, [this.lanes])]);
    /** @type {Partial<Record<"plays" | "moving" | "looping" | "frame" | "duration" | "frameRate", any>>} */
    this.shown = {};
    this.duration = 1;
    /** @type {Lane[]} */
    this.rows = [];
    /** @type {{reference: Reference, item: Item, edge: import("../scene/timing.js").Edge, changed: Item} | null} */
    this.dragged = null;
    /** @type {HTMLElement | null} lane to scroll to */
    this.revealed = null;
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
    const box = this.ruler.getBoundingClientRect();
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
    const { plays, moving, looping, duration, frameRate } = playback;
    const before = this.shown;
    this.shown = { plays, moving, looping, frame, duration, frameRate };
    if (plays !== before.plays) this.#showPlaying(plays);
    if (moving !== before.moving) this.play.disabled = this.slider.disabled = !moving;
    if (looping !== before.looping) this.loop.setAttribute("aria-pressed", String(looping));
    if (duration !== before.duration) {
      this.slider.max = String(duration - 1);
      if (globalThis.document.activeElement !== this.length) this.length.value = String(duration);
    } else if (frame === before.frame && frameRate === before.frameRate) return;
    this.slider.value = String(frame);
    this.readout.firstChild.data = `${frame} · ${(frame / frameRate).toFixed(2)} s`;
    // As a movement, for which nothing is laid out anew.
    this.now.style.transform = `translateX(${(100 * frame) / Math.max(duration - 1, 1)}%)`;
  }

  /** @param {boolean} playing */
  #showPlaying(playing) {
    const title = playing ? say("Pause (Space)") : say("Play (Space)");
    this.play.innerHTML = icon(playing ? "pause" : "play");
    this.play.title = title;
    this.play.setAttribute("aria-label", title);
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} selection
   * @param {number} duration  [s]
   */
  showItems(document, selection, duration) {
    this.duration = duration;
    const placed = allItems(document).filter(({ reference }) => reference.list !== "query_points").slice(0, MOST_LANES);
    const before = this.rows;
    this.rows = placed.map(({ reference, item }, number) => {
      const lane = before[number];
      return lane && isOf(lane, reference, item, duration) ? lane : this.#lane(reference, item, duration);
    });
    for (const { reference, root } of this.rows) {
      const chosen = selection?.list === reference.list && selection.index === reference.index;
      if (chosen && root.dataset.selected !== "true") this.revealed = root;
      root.dataset.selected = String(chosen);
    }
    if (this.rows.length && this.rows.length === before.length) {
      this.rows.forEach(({ root }, number) => root !== before[number].root && before[number].root.replaceWith(root));
      this.#reveal();
      return;
    }
    const empty = element("div", { className: "physanimator-empty" }, [say("What you draw appears here, with the times at which it acts.")]);
    this.lanes.replaceChildren(...(this.rows.length ? this.rows.map(({ root }) => root) : [empty]), ...(this.rows.length ? [this.ruler] : []));
    this.#reveal();
  }

  /** Scroll to the lane of what has just been selected, and nothing else on the page. */
  #reveal() {
    const { revealed } = this;
    this.revealed = null;
    const view = this.lanes.parentElement;
    if (!revealed || !view || this.dragged) return;
    const [above, below] = [revealed.offsetTop, revealed.offsetTop + revealed.offsetHeight];
    if (above < view.scrollTop) view.scrollTop = above;
    else if (below > view.scrollTop + view.clientHeight) view.scrollTop = below - view.clientHeight;
  }

  /**
   * @param {Reference} reference
   * @param {Item} item
   * @param {number} duration  [s]
   * @returns {Lane}
   */
  #lane(reference, item, duration) {
    const title = titleOf(reference, item);
    const name = element("span", { className: "physanimator-lane-name" }, [title]);
    const lane = element("div", { className: "physanimator-lane" });
    const root = element("div", { className: "physanimator-row", title, onclick: () => this.listener.select(reference) }, [name, lane]);
    root.style.setProperty("--physanimator-colour", colourOf(reference.list, item));
    const spans = spansOf(reference, item, duration).map(([from, to]) => this.#piece("physanimator-span", from, to, duration));
    const ticks = reference.list === "strokes" ? departures(item, duration).slice(0, 200) : [];
    const edges = edgesOf(reference, item, duration).map(([edge, time]) => {
      const grip = this.#piece("physanimator-edge", time, time, duration);
      grip.dataset.edge = edge;
      const values = { item: titleOf(reference, item) };
      grip.title = edge === "start" ? say("{item}: drag its start", values) : say("{item}: drag its end", values);
      grip.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => this.#grasp(event, reference, item, edge));
      return grip;
    });
    lane.append(...spans, ...ticks.map((time) => this.#piece("physanimator-tick", time, time, duration)), ...edges);
    return { reference, item, duration, root };
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

/**
 * Whether a lane shows just this.
 *
 * @param {Lane} lane
 * @param {Reference} reference
 * @param {Item} item
 * @param {number} duration  [s]
 */
function isOf(lane, { list, index }, item, duration) {
  return lane.item === item && lane.duration === duration && lane.reference.list === list && lane.reference.index === index;
}
