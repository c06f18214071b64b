/**
 * Bodies that no rig point holds: the first breeze carries them away, so the editor says so and offers to hold them.
 *
 * @typedef {import("./editor.js").Editor} Editor
 */

import { say } from "../host/words.js";
import { withHoldsAnew } from "../scene/holds.js";
import { withOfBody } from "../scene/layers.js";

const NOTE = "unheld";
const FOUND = "found";
/** Where a body is held that is found to be held nowhere. */
const USUAL = "auto";

export class Unheld {
  /** @param {Editor} editor */
  constructor(editor) {
    this.editor = editor;
    this.said = "";
  }

  /** @param {number[]} bodies  numbers of those that nothing holds, as the simulation tells them */
  show(bodies) {
    const { notes, options } = this.editor;
    const names = options.picks ? [] : bodies.map((number) => this.#name(number));
    const said = names.join(", ");
    if (said === this.said && (!said || notes.shown.has(NOTE))) return;
    this.said = said;
    const text = names.length === 1 ? say("Nothing holds {name}: it is carried away.", { name: said }) : say("Nothing holds {names}: they are carried away.", { names: said });
    const button = names.length === 1 ? say("Hold it where it is attached") : say("Hold them where they are attached");
    notes.show(NOTE, names.length ? text : "", { button: [button, () => this.#hold(bodies)] });
  }

  /** @param {number} number */
  #name(number) {
    const { materials } = this.editor.inspector.material;
    return materials?.bodies[number]?.name || say("Body {number}", { number });
  }

  /** @param {number[]} bodies */
  async #hold(bodies) {
    const { editor } = this;
    const key = editor.live.run?.key;
    if (!key) return;
    try {
      const found = await editor.live.client.holds(key, FOUND);
      const usual = found.some((hold) => !hold.points.length) ? await editor.live.client.holds(key, USUAL) : found;
      const holds = found.map((hold, i) => (hold.points.length ? hold : usual[i])).filter((hold) => bodies.includes(hold.body));
      let { document } = editor;
      for (const { name } of holds) {
        const said = document.bodies?.find((/** @type {any} */ body) => name && body.name === name)?.attach;
        if (said === "none") document = withOfBody(document, name, { attach: undefined });
      }
      editor.commit(withHoldsAnew(document, holds, editor.layerList.layers), null);
    } catch (error) {
      editor.backdrop.trouble(/** @type {Error} */ (error));
    }
  }
}
