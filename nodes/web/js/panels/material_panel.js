/**
 * The values of a body's material.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/layers.js").Layer} Layer
 * @typedef {import("../scene/materials.js").Materials} Materials
 * @typedef {import("../scene/materials.js").Target} Target
 */

import { say } from "../host/words.js";
import { materialFields, targetsOf, wholeOf, withMaterial, writtenOf } from "../scene/materials.js";
import { element } from "./elements.js";
import { fieldRow } from "./field_inputs.js";

export class MaterialPanel {
  /**
   * @param {(bodies: any[], key: string) => void} change  the document's bodies
   * @param {(target: Target) => void} choose
   */
  constructor(change, choose) {
    this.change = change;
    this.choose = choose;
    /** @type {Materials | null} until the node has run */
    this.materials = null;
    /** @type {Layer[]} */
    this.layers = [];
    /** As it is now: rows outlast changes while somebody types. @type {SceneDocument} */
    this.document = {};
    /** Young's moduli that came of sways in the last preview, by body. @type {(number | null)[]} */
    this.moduli = [];
    /** The longest of the picture [px]. */
    this.side = 1280;
  }

  /**
   * @param {{name: string, number: number}} chosen  body, by its name or its number
   * @returns {HTMLElement[]} none before the node has run
   */
  rows(chosen) {
    const { document } = this;
    const targets = targetsOf(document, this.materials, this.layers);
    if (!this.materials || !targets.length) return [];
    const target = targetOf(targets, chosen) ?? targets[0];
    const written = writtenOf(document, target);
    const whole = { preset: "own", ...wholeOf(written, this.materials) };
    const change = (/** @type {[string, any][]} */ changes, /** @type {string} */ key) => {
      const materials = /** @type {Materials} */ (this.materials);
      const made = withMaterial(this.document, target, changes, materials, this.layers, this.moduli[target.number]);
      this.change(made.bodies, key && `${target.label}.${key}`);
    };
    const fields = materialFields(this.materials, written);
    return [...this.#heading(targets, target), ...fields.map((field) => fieldRow(field, whole, change, this.side))];
  }

  /**
   * @param {{name: string, number: number}} chosen
   * @returns {boolean} whether it is a body that moves
   */
  shows(chosen) {
    return Boolean(targetOf(targetsOf(this.document, this.materials, this.layers), chosen));
  }

  /**
   * @param {Target[]} targets
   * @param {Target} target
   */
  #heading(targets, target) {
    const options = targets.map((one, i) => element("option", { value: String(i) }, [one.label]));
    const take = (/** @type {any} */ event) => this.choose(targets[Number(event.target.value)]);
    const select = element("select", { "aria-label": say("Body"), title: say("Whose material it is; a click on the picture chooses, too"), "data-body": "", onchange: take }, options);
    select.value = String(targets.indexOf(target));
    return [
      element("div", { className: "physanimator-heading" }, [say("Material")]),
      element("label", { className: "physanimator-field", "data-field": "material.body" }, [
        element("span", { className: "physanimator-caption" }, [say("Body")]),
        element("span", { className: "physanimator-inputs" }, [select]),
      ]),
    ];
  }
}

/**
 * @param {Target[]} targets
 * @param {{name: string, number: number}} chosen
 */
function targetOf(targets, chosen) {
  return targets.find((one) => (one.name ? one.name === chosen.name : one.number === chosen.number));
}
