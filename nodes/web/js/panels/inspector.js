/**
 * The panel of values: of the selected item, or of the scene.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("./field_inputs.js").Change} Change
 *
 * @typedef {object} InspectorListener
 * @property {(reference: Reference | null, changes: [string, any][], key: string) => void} change
 * @property {(kind: "circle" | "polygon" | "brush") => void} redrawRegion
 * @property {(radius: number) => void} brushSize
 * @property {(target: import("../scene/materials.js").Target) => void} chooseBody
 */

import { say, words } from "../host/words.js";
import { itemAt, LISTS } from "../scene/document.js";
import { CONTACT_FIELDS, fieldsOf, newMotion, SCENE_FIELDS, WIND_FIELDS } from "../scene/fields.js";
import { titleOf } from "../scene/items.js";
import { element } from "./elements.js";
import { fieldRow } from "./field_inputs.js";
import { MaterialPanel } from "./material_panel.js";

export class Inspector {
  /** @param {InspectorListener} listener */
  constructor(listener) {
    this.listener = listener;
    /** @type {any[]} on which depends what is shown */
    this.values = [];
    this.material = new MaterialPanel(
      (bodies, key) => this.listener.change(null, [["bodies", bodies]], key && `material.${key}`),
      (target) => this.listener.chooseBody(target),
    );
    /** The body that is chosen, by its name or its number; -1 for none. */
    this.body = { name: "", number: -1 };
    /** Whether a slider is being dragged. */
    this.sliding = false;
    this.side = 1280;
    this.root = element("div", { className: "physanimator-inspector", role: "group", "aria-label": say("Values") });
    this.root.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => (this.sliding = /** @type {any} */ (event.target).type === "range"));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) this.root.addEventListener(name, () => (this.sliding = false));
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} selection
   * @param {{radius: number} | null} brush  while a tool paints
   */
  show(document, selection, brush) {
    this.material.document = document;
    this.side = this.material.side = Math.max(document.width, document.height);
    const active = this.root.contains(globalThis.document.activeElement) && globalThis.document.activeElement;
    // The field in which somebody types is left alone: it shows what is typed, not what became of it.
    const typing = (this.sliding || (active && active.type === "number")) && this.subject === this.#subject(document, selection);
    if (typing) {
      this.values = [];
      return;
    }
    this.subject = this.#subject(document, selection);
    const item = itemAt(document, selection);
    const values = item ? [selection?.list, selection?.index, item, brush?.radius] : [brush?.radius, ...sceneValues(document), this.material.materials, this.body.name, this.body.number];
    if (values.length === this.values.length && values.every((value, i) => value === this.values[i])) return;
    this.values = values;
    const rows = selection && item ? this.#itemRows(selection, item) : this.#sceneRows(document);
    const held = active && active.type === "range" && active.closest("[data-field]")?.dataset.field;
    this.root.replaceChildren(...(brush ? [this.#brushRow(brush)] : []), ...rows);
    if (held) this.root.querySelector(`[data-field="${held}"] .physanimator-slide`)?.focus({ preventScroll: true });
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} selection
   */
  #subject(document, selection) {
    const item = itemAt(document, selection);
    return selection && item ? `${selection.list}.${selection.index}.${item.motion?.type ?? ""}` : `scene.${this.body.name}.${this.body.number}`;
  }

  /**
   * @param {Reference} selection
   * @param {any} item
   */
  #itemRows(selection, item) {
    /** @type {Change} */
    const change = (changes, key) => {
      const type = changes.find(([path]) => path === "motion.type")?.[1];
      this.listener.change(selection, type ? [["motion", newMotion(item, type)]] : changes, key && `${this.subject}.${key}`);
    };
    const rows = fieldsOf(selection, item).map((field) => fieldRow(field, item, change, this.side));
    const region = selection.list === "rig_points" ? [this.#regionRow(item)] : [];
    return [this.#heading(titleOf(selection, item)), ...rows, ...region];
  }

  /** @param {SceneDocument} document */
  #sceneRows(document) {
    /** @type {Change} */
    const change = (changes, key) => this.listener.change(null, changes, key && `scene.${key}`);
    const material = this.material.rows(this.body);
    const chosen = this.material.shows(this.body);
    return [
      ...(chosen ? material : []),
      this.#heading(say("Scene")),
      ...SCENE_FIELDS.map((field) => fieldRow(field, document, change, this.side)),
      ...this.#section(say("Wind everywhere"), "wind", document, WIND_FIELDS, change),
      ...this.#section(say("Contact"), "contact", document, CONTACT_FIELDS, change),
      ...(chosen ? [] : material),
    ];
  }

  /**
   * Fields of a part that may be left out as a whole.
   *
   * @param {string} title
   * @param {string} name
   * @param {SceneDocument} document
   * @param {import("../scene/fields.js").Field[]} fields
   * @param {Change} change
   */
  #section(title, name, document, fields, change) {
    const there = Boolean(document[name]);
    const box = element("input", {
      type: "checkbox",
      checked: there,
      "aria-label": title,
      onchange: () => change([[name, there ? undefined : {}]], ""),
    });
    const head = element("label", { className: "physanimator-field physanimator-section", "data-field": name }, [box, title]);
    return there ? [head, ...fields.map((field) => fieldRow(field, document, change, this.side))] : [head];
  }

  /** @param {string} text */
  #heading(text) {
    return element("div", { className: "physanimator-heading" }, [text]);
  }

  /** @param {any} item */
  #regionRow(item) {
    const kinds = /** @type {("circle" | "polygon" | "brush")[]} */ (words("circle", "polygon", "brush"));
    const current = item.region?.type === "mask" ? "brush" : (item.region?.type ?? "circle");
    const buttons = kinds.map((kind) =>
      element("button", {
        type: "button",
        title: say("Draw the region anew: {kind}", { kind: say(kind) }),
        "aria-pressed": String(kind === current),
        onclick: () => this.listener.redrawRegion(kind),
      }, [say(kind)]),
    );
    return element("div", { className: "physanimator-field", "data-field": "region" }, [
      element("span", { className: "physanimator-caption" }, [say("Region")]),
      element("span", { className: "physanimator-inputs" }, buttons),
    ]);
  }

  /** @param {{radius: number}} brush */
  #brushRow(brush) {
    const field = /** @type {import("../scene/fields.js").Field} */ ({
      path: "radius", title: say("Brush radius"), unit: "px", kind: "number", min: 1, max: 5000, step: 1, hint: say("How broad the brush is; the keys [ and ] change it too."),
    });
    return fieldRow(field, brush, (changes) => this.listener.brushSize(changes[0][1]), this.side);
  }
}

/**
 * What a document says besides its items.
 *
 * @param {SceneDocument} document
 */
function sceneValues(document) {
  return Object.entries(document).flatMap(([name, value]) => (LISTS.includes(name) ? [] : [name, value]));
}
