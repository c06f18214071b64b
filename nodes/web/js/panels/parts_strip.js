/**
 * The parts that are picked, side by side under the tools: which of them a click adds to, and what each is made of.
 *
 * @typedef {object} StripListener
 * @property {() => void} picture  another picture is wanted
 * @property {(part: number) => void} choose
 * @property {() => void} more  a new part
 * @property {(part: number, preset: string) => void} make
 * @property {(part: number) => void} remove
 * @property {(result: boolean) => void} view  the result, or the picture to pick on
 *
 * @typedef {object} StripState
 * @property {number} count  of the parts
 * @property {number} current
 * @property {number[]} points  on each part
 * @property {string[]} presets  of each part; empty for the node's
 * @property {boolean} result  whether there is one
 * @property {boolean} viewed  whether it is looked at
 */

import { say } from "../host/words.js";
import { partColour } from "../stage/colours.js";
import { element } from "./elements.js";

const STYLE = `
.physanimator-parts { display: flex; flex-wrap: wrap; align-items: center; gap: 4px; flex: 1 0 100%; padding: 3px 4px 1px; border-top: 1px solid var(--physanimator-rim); }
.physanimator-part { display: inline-flex; flex: none; align-items: center; height: 26px; border: 1px solid var(--physanimator-rim); border-radius: 13px; overflow: hidden; }
.physanimator-part[data-current="true"] { border-color: var(--physanimator-part); box-shadow: 0 0 0 1px var(--physanimator-part); background: var(--physanimator-field); }
.physanimator-editor .physanimator-part button { height: 24px; border-radius: 0; white-space: nowrap; }
.physanimator-part .physanimator-part-name::before { content: ""; width: 10px; height: 10px; margin: 0 6px 0 3px; border-radius: 50%; background: var(--physanimator-part); }
.physanimator-part[data-empty="true"] .physanimator-part-name::before { background: transparent; box-shadow: inset 0 0 0 2px var(--physanimator-part); }
.physanimator-editor .physanimator-part select { width: auto; max-width: 92px; height: 22px; border: 0; background: transparent; appearance: auto; cursor: pointer; }
.physanimator-editor .physanimator-part select option { color: var(--physanimator-text); background: var(--physanimator-back); }
.physanimator-editor .physanimator-parts > button { border: 1px solid var(--physanimator-rim); border-radius: 13px; padding: 0 10px; white-space: nowrap; }
.physanimator-more { margin-left: 5px; }
@container (max-width: 379px) {
  .physanimator-editor > .physanimator-frame .physanimator-parts { flex-wrap: nowrap; flex: 1 1 100%; min-width: 0; overflow-x: auto; scrollbar-width: none; }
  .physanimator-editor > .physanimator-frame .physanimator-parts > button { flex: none; position: sticky; right: 0; padding: 0; background: var(--physanimator-back); }
  .physanimator-editor > .physanimator-frame .physanimator-more { display: none; }
}
.physanimator-parts-corner { display: flex; align-items: center; gap: 6px; margin-left: auto; padding: 0 4px; }
.physanimator-editor .physanimator-parts-corner > button { border: 1px solid var(--physanimator-rim); padding: 0 10px; white-space: nowrap; }
.physanimator-view { display: inline-flex; border: 1px solid var(--physanimator-rim); border-radius: 6px; overflow: hidden; }
.physanimator-view[hidden] { display: none; }
.physanimator-editor .physanimator-view button { height: 24px; border-radius: 0; padding: 0 8px; white-space: nowrap; }
`;

export class PartsStrip {
  /**
   * @param {StripListener} listener
   * @param {{presets: string[], picture: boolean}} options  presets to choose from, and whether the node has a picture of its own
   */
  constructor(listener, { presets, picture }) {
    this.listener = listener;
    this.presets = presets;
    this.shown = "";
    this.current = 0;
    this.chips = element("span", { style: "display: contents" });
    const more = { type: "button", "data-action": "new-part", "aria-label": say("New part"), title: say("The next clicks pick another part, with a mask and a material of its own (or hold Shift while you click)"), onclick: () => listener.more() };
    const other = { type: "button", "data-action": "picture", title: say("Choose a picture from your computer, or drop or paste one here"), onclick: () => listener.picture() };
    const turn = (/** @type {boolean} */ result) => ({ type: "button", "data-action": result ? "view-result" : "view-picking", onclick: () => listener.view(result) });
    this.picking = element("button", { ...turn(false), title: say("The picture, to pick on, with the motion live") }, [say("Pick")]);
    this.result = element("button", { ...turn(true), title: say("The frames of the last run") }, [say("Result")]);
    this.view = element("span", { className: "physanimator-view", hidden: true }, [this.picking, this.result]);
    this.more = element("button", more, ["+", element("span", { className: "physanimator-more" }, [say("New part")])]);
    const rows = [element("style", { textContent: STYLE }), this.chips, this.more];
    /** @type {HTMLElement} */
    this.root = element("div", { className: "physanimator-parts", role: "group", "aria-label": say("Parts") }, rows);
    new ResizeObserver(() => this.#keepInSight()).observe(this.root);
    /** @type {HTMLElement} beside the tools */
    this.corner = element("div", { className: "physanimator-parts-corner" }, [this.view, ...(picture ? [element("button", other, [say("Picture…")])] : [])]);
  }

  /** @param {StripState} state */
  show(state) {
    const shown = JSON.stringify(state);
    if (shown === this.shown) return;
    this.shown = shown;
    this.chips.replaceChildren(...Array.from({ length: state.count }, (_, part) => this.#chip(part, state)));
    this.current = state.current;
    this.#keepInSight();
    this.more.disabled = !state.points[state.current];
    this.view.hidden = !state.result;
    this.picking.setAttribute("aria-pressed", String(!state.viewed));
    this.result.setAttribute("aria-pressed", String(state.viewed));
  }

  /** Where the strip is too narrow for all parts, it shows that to which clicks add, and what follows it. */
  #keepInSight() {
    const [first, here] = [0, this.current].map((number) => /** @type {HTMLElement | undefined} */ (this.chips.children[number]));
    if (first && here) this.root.scrollLeft = here.offsetLeft - first.offsetLeft;
  }

  /**
   * @param {number} part
   * @param {StripState} state
   */
  #chip(part, { current, points, presets, count }) {
    const { listener } = this;
    const name = say("Part {number}", { number: part + 1 });
    const choose = element("button", { type: "button", className: "physanimator-part-name", "aria-pressed": undefined, "data-part": part, title: say("Clicks add to {part}", { part: name }), onclick: () => listener.choose(part) }, [name]);
    const inside = [choose];
    if (this.presets.length) inside.push(this.#presets(part, presets[part], name));
    if (count > 1 || points[part]) {
      inside.push(element("button", { type: "button", "data-remove": part, title: say("Remove {part}", { part: name }), "aria-label": say("Remove {part}", { part: name }), onclick: () => listener.remove(part) }, ["×"]));
    }
    const chip = element("span", { className: "physanimator-part", "data-current": part === current, "data-empty": !points[part] }, inside);
    chip.style.setProperty("--physanimator-part", partColour(part));
    return chip;
  }

  /**
   * @param {number} part
   * @param {string} preset
   * @param {string} name
   */
  #presets(part, preset, name) {
    const options = ["", ...this.presets].map((one) => element("option", { value: one, selected: one === preset }, [one ? say(one) : say("usual")]));
    return element("select", { title: say("What {part} is made of", { part: name }), "aria-label": say("What {part} is made of", { part: name }), "data-preset": part, onchange: (/** @type {any} */ event) => this.listener.make(part, event.target.value) }, options);
  }
}
