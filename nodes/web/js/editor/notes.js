/** Sentences over the picture: what went wrong, what to do, what has just happened. */

import { say } from "../host/words.js";
import { element } from "../panels/elements.js";

const PASSING = 7000;

export class Notes {
  constructor() {
    this.root = element("div", { className: "physanimator-notes", "aria-live": "polite" });
    /** @type {Map<string, HTMLElement>} */
    this.shown = new Map();
  }

  /**
   * @param {string} name  of the place; a new sentence takes the place of the old one
   * @param {string} text  empty: nothing
   * @param {{kind?: "info" | "error", passing?: boolean, closes?: boolean, button?: [string, () => void]}} [options]
   */
  show(name, text, { kind = "info", passing = false, closes = false, button } = {}) {
    this.shown.get(name)?.remove();
    this.shown.delete(name);
    if (!text) return;
    const more = button ? [element("button", { type: "button", onclick: button[1], "data-action": name }, [button[0]])] : [];
    if (closes) more.push(element("button", { type: "button", className: "physanimator-close", onclick: () => this.show(name, ""), title: say("Close"), "aria-label": say("Close") }, ["×"]));
    const note = element("div", { className: "physanimator-note", "data-kind": kind, "data-note": name, role: kind === "error" ? "alert" : "status" }, [text, ...more]);
    this.shown.set(name, note);
    this.root.append(note);
    if (passing) setTimeout(() => this.shown.get(name) === note && this.show(name, ""), PASSING);
  }

  /**
   * Show a sentence where it is not shown yet: screen readers say a new one each time.
   *
   * @param {string} name
   * @param {string} text  empty: nothing
   */
  keep(name, text) {
    if ((this.shown.get(name)?.textContent ?? "") !== text) this.show(name, text);
  }

  /**
   * Sentences under which the pointer is hide what it points at: they fade until it has left.
   *
   * @param {PointerEvent} event
   */
  makeWay({ clientX: x, clientY: y, type }) {
    const under = (/** @type {DOMRect} */ { left, right, top, bottom }) => x >= left && x <= right && y >= top && y <= bottom;
    const away = type !== "pointerleave" && [...this.shown.values()].some((note) => under(note.getBoundingClientRect()));
    this.root.toggleAttribute("data-away", away);
  }

  /** @param {string} sentence that goes away by itself */
  say(sentence) {
    this.show("said", sentence, { passing: true });
  }
}
