/**
 * The list of an artwork's layers, from front to back: seen or not, moving or not, and of what.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/layers.js").Layer} Layer
 *
 * @typedef {object} LayerListener
 * @property {(layer: Layer | null) => void} choose
 * @property {(layer: Layer) => void} look  show it, or do not
 * @property {(layer: Layer, moves: boolean) => void} move
 * @property {(layer: Layer, preset: string) => void} make
 *
 * @typedef {object} Row
 * @property {Layer} layer
 * @property {any} root
 * @property {any} eye
 * @property {any} name
 * @property {any} moves
 * @property {any} preset
 */

import { movesIn, PRESETS, presetIn } from "../scene/layers.js";
import { element } from "./elements.js";
import { icon } from "./icons.js";

/** @type {Record<string, number>} */
const STEPS = { ArrowUp: -1, ArrowDown: 1, Home: -Infinity, End: Infinity };

export class LayerList {
  /** @param {LayerListener} listener */
  constructor(listener) {
    this.listener = listener;
    /** @type {Layer[]} */
    this.layers = [];
    /** @type {Row[]} */
    this.rows = [];
    this.list = element("ul", { className: "physanimator-layer-list", onkeydown: (/** @type {KeyboardEvent} */ event) => this.#step(event) });
    this.root = element("div", { className: "physanimator-layers", role: "group", "aria-label": "Layers", hidden: true }, [
      element("div", { className: "physanimator-heading" }, ["Layers"]),
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
    const moving = this.layers.filter((layer) => movesIn(document, layer)).length;
    for (const row of this.rows) {
      const { layer } = row;
      const moves = movesIn(document, layer);
      const seen = layer.shown && !unseen.has(layer.index);
      row.root.dataset.chosen = String(layer === chosen);
      row.name.setAttribute("aria-pressed", String(layer === chosen));
      row.eye.setAttribute("aria-pressed", String(seen));
      row.moves.checked = moves;
      // A scene needs something that moves.
      row.moves.disabled = !layer.shown || (moves && moving === 1);
      row.preset.hidden = !moves;
      if (moves) choose(row.preset, presetIn(document, layer));
    }
  }

  /** @param {Layer} layer to bring into sight */
  reveal(layer) {
    this.rows.find((row) => row.layer === layer)?.root.scrollIntoView?.({ block: "nearest" });
  }

  /**
   * @param {Layer} layer
   * @returns {Row}
   */
  #row(layer) {
    const { listener } = this;
    const { name } = layer;
    const hidden = layer.shown ? "" : " (hidden in the file)";
    const eye = element("button", {
      type: "button", className: "physanimator-eye", innerHTML: icon("items"), disabled: !layer.shown, "aria-label": `Show ${name}`,
      title: layer.shown ? "Show it in this preview; what is rendered stays the same" : "Hidden in the file", "data-eye": name, onclick: () => listener.look(layer),
    });
    const title = element("button", { type: "button", className: "physanimator-layer-name", title: `${name}${hidden}`, "data-layer": name, onclick: () => listener.choose(layer) }, [name]);
    const moves = element("input", {
      type: "checkbox", "aria-label": `${name} moves`, title: "Whether it moves; at least one layer must", "data-moves": name,
      onchange: (/** @type {any} */ event) => listener.move(layer, event.target.checked),
    });
    const options = PRESETS.map((preset) => element("option", { value: preset }, [preset]));
    const preset = element("select", {
      "aria-label": `What ${name} is made of`, title: "What it is made of", "data-preset": name, onchange: (/** @type {any} */ event) => listener.make(layer, event.target.value),
    }, options);
    const root = element("li", { className: "physanimator-layer", "data-shown": String(layer.shown) }, [eye, title, preset, moves]);
    return { layer, root, eye, name: title, moves, preset };
  }

  /** @param {KeyboardEvent} event */
  #step(event) {
    const step = STEPS[event.key];
    const at = this.rows.findIndex((row) => row.name === event.target);
    if (step === undefined || at < 0) return;
    const next = this.rows[Math.min(Math.max(at + step, 0), this.rows.length - 1)];
    next.name.focus();
    this.listener.choose(next.layer);
    event.preventDefault();
    event.stopPropagation();
  }
}

/**
 * @param {any} select
 * @param {string} value  which need not be among its options
 */
function choose(select, value) {
  if (![...select.options].some((option) => option.value === value)) select.append(element("option", { value }, [value || "own"]));
  if (select.value !== value) select.value = value;
}
