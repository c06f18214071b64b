/**
 * The list of an artwork's layers, from front to back: seen or not, moving or not, of what, held where, and their order.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/layers.js").Layer} Layer
 *
 * @typedef {object} LayerListener
 * @property {(layer: Layer | null) => void} choose
 * @property {(layer: Layer) => void} [look]  show it, or do not; left out where there is nothing to look at
 * @property {(layer: Layer, moves: boolean) => void} move
 * @property {(layer: Layer, preset: string) => void} make
 * @property {(layer: Layer, attach: string) => void} attach
 * @property {(layer: Layer, places: number) => void} place  further to the front; below 0 to the back
 *
 * @typedef {object} Row
 * @property {Layer} layer
 * @property {any} root
 * @property {any} eye
 * @property {any} name
 * @property {any} moves
 * @property {any} said  what it is made of and where it is held, in words
 * @property {any} more  the same to choose, of the layer that is selected
 * @property {any} preset
 * @property {any} attach
 */

import { say } from "../host/words.js";
import { SIDES } from "../scene/holds.js";
import { attachIn, inOrder, movesIn, PRESETS, presetIn } from "../scene/layers.js";
import { element } from "./elements.js";
import { icon } from "./icons.js";

/** @type {Record<string, number>} */
const STEPS = { ArrowUp: -1, ArrowDown: 1, Home: -Infinity, End: Infinity };
/** How far a name is drawn before the layer comes along [px of the screen]. */
const DRAWN = 6;

export class LayerList {
  /** @param {LayerListener} listener */
  constructor(listener) {
    this.listener = listener;
    /** @type {Layer[]} */
    this.layers = [];
    /** @type {Row[]} as they are shown */
    this.rows = [];
    this.list = element("ul", { className: "physanimator-layer-list", onkeydown: (/** @type {KeyboardEvent} */ event) => this.#step(event) });
    this.root = element("div", { className: "physanimator-layers", role: "group", "aria-label": say("Layers"), hidden: true }, [
      element("div", { className: "physanimator-heading" }, [say("Layers")]),
      this.list,
    ]);
  }

  /** @param {Layer[]} layers  from front to back; none where the picture is not in layers */
  setLayers(layers) {
    this.layers = layers;
    this.rows = layers.map((layer) => this.#row(layer));
    this.list.replaceChildren(...this.rows.map((row) => row.root));
    this.root.hidden = !layers.length;
  }

  /**
   * @param {SceneDocument} document
   * @param {Layer | null} chosen
   * @param {Set<number>} unseen  indices of layers that are not to be looked at
   */
  show(document, chosen, unseen) {
    this.#arrange(inOrder(document, this.layers));
    const moving = this.layers.filter((layer) => movesIn(document, layer)).length;
    for (const row of this.rows) {
      const { layer } = row;
      const moves = movesIn(document, layer);
      row.root.dataset.chosen = String(layer === chosen);
      row.name.setAttribute("aria-pressed", String(layer === chosen));
      row.eye?.setAttribute("aria-pressed", String(layer.shown && !unseen.has(layer.index)));
      row.moves.checked = moves;
      // A scene needs something that moves.
      row.moves.disabled = !layer.shown || Boolean(layer.fixed) || (moves && moving === 1);
      row.said.hidden = !moves || layer === chosen;
      row.more.hidden = !moves || layer !== chosen;
      if (!moves) continue;
      const [made, held] = [presetIn(document, layer), attachIn(document, layer)];
      row.said.textContent = `${say(made)} · ${SIDES[/** @type {"auto"} */ (held)] ?? held}`;
      choose(row.preset, made);
      choose(row.attach, held);
    }
  }

  /** @param {Layer} layer to bring into sight */
  reveal(layer) {
    this.rows.find((row) => row.layer === layer)?.root.scrollIntoView?.({ block: "nearest" });
  }

  /** @param {Layer[]} order  from front to back */
  #arrange(order) {
    if (order.every((layer, i) => this.rows[i].layer === layer)) return;
    const focus = globalThis.document.activeElement;
    this.rows.sort((one, other) => order.indexOf(one.layer) - order.indexOf(other.layer));
    this.list.append(...this.rows.map((row) => row.root));
    if (this.list.contains(focus)) /** @type {HTMLElement} */ (focus).focus();
  }

  /**
   * @param {Layer} layer
   * @returns {Row}
   */
  #row(layer) {
    const { listener } = this;
    const { name } = layer;
    const why = layer.shown ? (layer.why ?? "") : say("hidden in the file");
    const eye = listener.look && element("button", {
      type: "button", className: "physanimator-eye", innerHTML: icon("items"), disabled: !layer.shown, "aria-label": say("Show {name}", { name }),
      title: layer.shown ? say("Show it in this preview; what is rendered stays the same") : say("Hidden in the file"), "data-eye": name, onclick: () => listener.look?.(layer),
    });
    const title = element("button", {
      type: "button", className: "physanimator-layer-name", title: say("{name}; drag it, or Alt and arrows, to move it in front of others", { name: name + (why && ` (${why})`) }),
      "data-layer": name, onclick: () => listener.choose(layer), onpointerdown: (/** @type {PointerEvent} */ event) => this.#drag(event, layer),
    }, [name]);
    const moves = element("input", {
      type: "checkbox", "aria-label": say("{name} moves", { name }), "data-moves": name,
      title: layer.fixed ? say("Another input of this node says whether it moves") : say("Whether it moves; at least one layer must"),
      onchange: (/** @type {any} */ event) => listener.move(layer, event.target.checked),
    });
    const preset = this.#select(say("What {name} is made of", { name }), "data-preset", name, PRESETS.map((each) => [each, say(each)]), (value) => listener.make(layer, value));
    const attach = this.#select(say("Where {name} is held", { name }), "data-attach", name, Object.entries(SIDES), (value) => listener.attach(layer, value));
    const step = (/** @type {number} */ places, /** @type {string} */ sign, /** @type {string} */ where, /** @type {string} */ title, /** @type {string} */ label) =>
      element("button", { type: "button", className: "physanimator-place", title, "aria-label": label, "data-place": `${where} ${name}`, onclick: () => listener.place(layer, places) }, [sign]);
    const front = step(1, "▴", "front", say("One further to the front"), say("{name} further to the front", { name }));
    const back = step(-1, "▾", "back", say("One further to the back"), say("{name} further to the back", { name }));
    const said = element("span", { className: "physanimator-layer-said", title: say("What it is made of, and where it is held; click to change it"), onclick: () => listener.choose(layer) });
    const more = element("div", { className: "physanimator-layer-more", hidden: true }, [preset, attach]);
    const line = element("div", { className: "physanimator-layer-line" }, [...(eye ? [eye] : []), title, said, front, back, moves]);
    const root = element("li", { className: "physanimator-layer", "data-shown": String(layer.shown) }, [line, more]);
    return { layer, root, eye, name: title, moves, said, more, preset, attach };
  }

  /**
   * @param {string} label
   * @param {string} key
   * @param {string} name
   * @param {string[][]} options  value and text of each
   * @param {(value: string) => void} take
   */
  #select(label, key, name, options, take) {
    const made = options.map(([value, text]) => element("option", { value }, [text]));
    return element("select", { "aria-label": label, title: label, [key]: name, onchange: (/** @type {any} */ event) => take(event.target.value) }, made);
  }

  /**
   * Take a layer along with the pointer, and leave it where the pointer leaves it.
   *
   * @param {PointerEvent} event
   * @param {Layer} layer
   */
  #drag(event, layer) {
    if (event.button) return;
    const row = this.rows.find((one) => one.layer === layer);
    const name = row?.name;
    const begun = event.clientY;
    let places = 0;
    const move = (/** @type {PointerEvent} */ now) => {
      const away = Math.abs(now.clientY - begun) > DRAWN;
      const from = this.rows.findIndex((one) => one.layer === layer);
      // The rows that the pointer has passed by more than half.
      const middles = this.rows.map(({ root }) => root.getBoundingClientRect()).map((box) => (box.top + box.bottom) / 2);
      const to = away ? middles.filter((middle, i) => i !== from && middle < now.clientY).length : from;
      places = from - to;
      this.rows.forEach(({ root }, i) => (root.dataset.target = i === to && places ? (places > 0 ? "above" : "below") : ""));
    };
    const end = (/** @type {PointerEvent} */ now) => {
      for (const kind of ["pointermove", "pointerup", "pointercancel"]) name.removeEventListener(kind, kind === "pointermove" ? move : end);
      for (const { root } of this.rows) root.dataset.target = "";
      if (now.type === "pointerup" && places) this.listener.place(layer, places);
    };
    name.setPointerCapture(event.pointerId);
    name.addEventListener("pointermove", move);
    name.addEventListener("pointerup", end);
    name.addEventListener("pointercancel", end);
    event.stopPropagation();
  }

  /** @param {KeyboardEvent} event */
  #step(event) {
    const step = STEPS[event.key];
    const at = this.rows.findIndex((row) => row.name === event.target);
    if (step === undefined || at < 0) return;
    const row = this.rows[at];
    if (event.altKey) {
      this.listener.place(row.layer, Math.min(Math.max(-step, -this.rows.length), this.rows.length));
      row.name.focus();
    } else {
      const next = this.rows[Math.min(Math.max(at + step, 0), this.rows.length - 1)];
      next.name.focus();
      this.listener.choose(next.layer);
    }
    event.preventDefault();
    event.stopPropagation();
  }
}

/**
 * @param {any} select
 * @param {string} value  which need not be among its options
 */
function choose(select, value) {
  if (![...select.options].some((option) => option.value === value)) select.append(element("option", { value }, [say(value || "own")]));
  if (select.value !== value) select.value = value;
}
