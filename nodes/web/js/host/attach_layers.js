/**
 * The list of an artwork's layers in a node: what moves, of what, where it is held, and the order. What it says is the
 * value of a text input, a scene document as the scene editor writes it.
 */

import { element } from "../panels/elements.js";
import { LayerList } from "../panels/layer_list.js";
import { STYLE } from "../panels/style.js";
import { emptyDocument, parseDocument, serialise } from "../scene/document.js";
import { withAttach } from "../scene/holds.js";
import { isAsRun, withMoves, withPlace, withPreset } from "../scene/layers.js";
import { LAYERS } from "./attach.js";
import { isConnected } from "./links.js";
import { executionId, runNode } from "./queueing.js";
import { chain, embed, hide, tell } from "./widgets.js";
import { say } from "./words.js";

/** Time from one look at the graph to the next [ms]. */
const LOOKS = 500;
const SHORTEST = 120;
/** @type {[number, number]} of a new node, at least */
const SIZE = [400, 660];
const OUTPUT = "physanimator_layers";
const NOT_YET = say("The layers are listed here once this node has run.");
const NONE = say("No layer moves by its name: switch on what is to move, then run.");
const OTHERS = say("Other layers are to move in the next run.");
const CONNECTED = say("The scene that is connected says what moves.");

/**
 * @param {any} app  the host's
 * @param {any} api  the host's
 * @param {any} node
 * @param {string} input  name of the text input
 */
export function attachLayers(app, api, node, input) {
  const value = node.widgets?.find((/** @type {any} */ widget) => widget.name === input);
  if (!value) return null;
  const list = new NodeLayers(app, node, value);
  hide(value);
  embed(node, "physanimator_layers", list.root, SHORTEST);
  let opened = false;
  chain(node, "onConfigure", () => (opened = true));
  queueMicrotask(() => opened || node.setSize?.([Math.max(node.size[0], SIZE[0]), Math.max(node.size[1], SIZE[1])]));
  const ran = (/** @type {any} */ output) => output?.[OUTPUT]?.[0] && list.take(output[OUTPUT][0]);
  const refused = (/** @type {any} */ { detail }) => {
    if (node.graph && detail.node === executionId(node, app.rootGraph ?? app.graph)) list.take(detail);
  };
  api.addEventListener(LAYERS, refused);
  chain(node, "onExecuted", ran);
  /** @type {any} */
  let remains = 0;
  chain(node, "onAdded", () => {
    clearInterval(remains);
    remains = setInterval(() => list.look(), LOOKS);
  });
  chain(node, "onRemoved", () => {
    clearInterval(remains);
    api.removeEventListener(LAYERS, refused);
  });
  queueMicrotask(() => {
    list.look();
    ran(app.nodeOutputs?.[String(node.id)]);
  });
  return list;
}

export class NodeLayers {
  /**
   * @param {any} app
   * @param {any} node
   * @param {any} value  the widget whose text is the document
   */
  constructor(app, node, value) {
    this.app = app;
    this.node = node;
    this.value = value;
    this.size = { width: 1280, height: 720 };
    /** Name of the layer that is selected. */
    this.chosen = "";
    /** @type {unknown[]} on which depends what is shown */
    this.seen = [];
    const layers = () => this.list.layers;
    this.list = new LayerList({
      choose: (layer) => this.#choose(layer?.name ?? ""),
      move: (layer, moves) => this.#commit(withMoves(this.document, layer, moves, layers()), layer.name),
      make: (layer, preset) => this.#commit(withPreset(this.document, layer, preset, layers()), layer.name),
      attach: (layer, attach) => this.#commit(withAttach(this.document, layer, attach, null, layers()), layer.name),
      place: (layer, places) => this.#commit(withPlace(this.document, layer, places, layers()), layer.name),
    });
    this.note = element("div", { className: "physanimator-list-note", role: "status" });
    this.run = element("button", { type: "button", "data-action": "run", title: say("Run this node"), onclick: () => runNode(app, node) }, [say("Run")]);
    const style = element("style", { textContent: STYLE });
    const line = element("div", { className: "physanimator-list-line" }, [this.note, this.run]);
    /** @type {HTMLElement} */
    this.root = element("div", { className: "physanimator-editor physanimator-list-only", "data-capture-wheel": "true" }, [style, line, this.list.root]);
  }

  /** What the text says; nothing where it cannot be read. */
  get document() {
    try {
      return parseDocument(String(this.value.value));
    } catch {
      return emptyDocument(this.size.width, this.size.height);
    }
  }

  get connected() {
    const slot = (this.node.inputs ?? []).findIndex((/** @type {any} */ one) => one.name === this.value.name);
    return isConnected(this.node, slot);
  }

  /** @param {{width: number, height: number, layers: import("../scene/layers.js").Layer[]}} told  by a run */
  take({ width, height, layers }) {
    this.size = { width, height };
    this.list.setLayers(layers);
    this.seen = [];
    this.look();
  }

  /** Show what the text says, if it has changed. */
  look() {
    const seen = [this.value.value, this.connected, this.chosen, this.list.layers];
    if (seen.every((one, i) => one === this.seen[i])) return;
    this.seen = seen;
    const { document } = this;
    const { layers } = this.list;
    const chosen = layers.find((layer) => layer.name === this.chosen) ?? null;
    this.list.show(document, chosen, new Set());
    this.list.root.inert = this.connected;
    const none = layers.every((layer) => !layer.moving);
    this.note.textContent = this.connected ? CONNECTED : !layers.length ? NOT_YET : none ? NONE : isAsRun(document, layers) ? "" : OTHERS;
    this.run.hidden = !this.note.textContent || this.connected;
  }

  /** @param {string} name */
  #choose(name) {
    this.chosen = name;
    this.look();
    const layer = this.list.layers.find((one) => one.name === name);
    if (layer) this.list.reveal(layer);
  }

  /**
   * @param {import("../scene/document.js").SceneDocument} document
   * @param {string} chosen
   */
  #commit(document, chosen) {
    this.chosen = chosen;
    // Without rig points of its own a document has no word on where the layers are held that it names.
    const { rig_points: points, ...rest } = document;
    this.value.value = serialise(points?.length ? document : rest);
    tell(this.app, this.node, this.value);
    this.look();
  }
}
