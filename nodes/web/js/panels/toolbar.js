/**
 * The buttons above the picture: tools, changes, view.
 *
 * @typedef {object} Action
 * @property {string} id  also the name of its icon
 * @property {string} title
 * @property {string} [key]  shortcut, as a person writes it
 * @property {boolean} [tool]  stays chosen until another tool is
 * @property {boolean} [toggle]
 */

import { say } from "../host/words.js";
import { element } from "./elements.js";
import { icon } from "./icons.js";

/** @type {Record<string, Action>} */
export const ACTIONS = {
  select: { id: "select", title: say("Select and drag items, points and handles"), key: "V", tool: true },
  "query-positive": { id: "query-positive", title: say("Point on the part"), key: "Q", tool: true },
  "query-negative": { id: "query-negative", title: say("Point beside the part"), key: "N", tool: true },
  wind: { id: "wind", title: say("Wind: draw where it blows"), key: "W", tool: true },
  repel: { id: "repel", title: say("Repel: draw what pushes away (a click rests)"), key: "R", tool: true },
  attract: { id: "attract", title: say("Attract: draw what pulls closer (a click rests)"), key: "A", tool: true },
  pin: { id: "pin", title: say("Pin: click to hold a spot"), key: "P", tool: true },
  path: { id: "path", title: say("Lead: drag a spot along, as fast as it shall go"), key: "L", tool: true },
  wave: { id: "wave", title: say("Wave: drag as far as it shall swing"), key: "S", tool: true },
  "region-circle": { id: "region-circle", title: say("Held circle: drag from its middle"), key: "C", tool: true },
  "region-polygon": { id: "region-polygon", title: say("Held outline: draw around it, or click its corners"), key: "G", tool: true },
  "region-brush": { id: "region-brush", title: say("Held area: paint it; Alt takes away, [ and ] change the size"), key: "B", tool: true },
  stiffness: { id: "stiffness", title: say("Stiffness: paint what is stiffer; Alt takes away, [ and ] change the size"), key: "F", tool: true },
  erase: { id: "erase", title: say("Erase what the pointer passes over"), key: "E", tool: true },
  hold: { id: "hold", title: say("Hold every body where it is found to be held, instead of its pins"), key: "T" },
  undo: { id: "undo", title: say("Undo"), key: "Ctrl+Z" },
  redo: { id: "redo", title: say("Redo"), key: "Ctrl+Shift+Z" },
  duplicate: { id: "duplicate", title: say("Duplicate the selected item"), key: "Ctrl+D" },
  delete: { id: "delete", title: say("Delete the selected item"), key: "Delete" },
  "zoom-out": { id: "zoom-out", title: say("Zoom out"), key: "-" },
  fit: { id: "fit", title: say("Show the whole picture"), key: "0" },
  "zoom-in": { id: "zoom-in", title: say("Zoom in"), key: "+" },
  mesh: { id: "mesh", title: say("Show the mesh"), key: "M", toggle: true },
  items: { id: "items", title: say("Show what is drawn"), key: "H", toggle: true },
  panel: { id: "panel", title: say("Show the values"), key: "I", toggle: true },
  expand: { id: "expand", title: say("Edit in the whole window"), key: "X", toggle: true },
};

export const SCENE_GROUPS = [
  ["select", "erase"],
  ["wind", "repel", "attract"],
  ["pin", "path", "wave", "hold"],
  ["region-circle", "region-polygon", "region-brush"],
  ["stiffness"],
  ["undo", "redo", "duplicate", "delete"],
  ["zoom-out", "fit", "zoom-in"],
  ["mesh", "items", "panel", "expand"],
];

export const POINT_GROUPS = [
  ["query-positive", "query-negative"],
  ["select", "erase"],
  ["undo", "redo", "delete"],
  ["zoom-out", "fit", "zoom-in"],
  ["expand"],
];

export const PICK_GROUPS = [
  ["query-positive", "query-negative"],
  ["select", "erase"],
  ["undo", "redo", "delete"],
  ["zoom-out", "fit", "zoom-in"],
  ["mesh", "items", "expand"],
];

export class Toolbar {
  /**
   * @param {string[][]} groups
   * @param {(id: string) => void} onAction
   */
  constructor(groups, onAction) {
    /** @type {Map<string, HTMLButtonElement>} */
    this.buttons = new Map();
    this.root = element("div", { className: "physanimator-toolbar", role: "toolbar", "aria-label": say("Scene editor") });
    for (const group of groups) {
      const made = group.map((id) => this.#button(ACTIONS[id], onAction));
      this.root.append(element("div", { className: "physanimator-group" }, made));
    }
  }

  /**
   * @param {Action} action
   * @param {(id: string) => void} onAction
   */
  #button({ id, title, key, tool, toggle }, onAction) {
    const button = element("button", {
      type: "button",
      title: key ? `${title} (${key})` : title,
      innerHTML: icon(id),
      "aria-label": title,
      "aria-keyshortcuts": key ? key.replace("Ctrl", "Control") : undefined,
      "aria-pressed": tool || toggle ? "false" : undefined,
      "data-action": id,
      onclick: () => onAction(id),
    });
    this.buttons.set(id, button);
    return button;
  }

  /**
   * @param {Record<string, boolean>} pressed  by the button's id
   * @param {Record<string, boolean>} disabled
   */
  show(pressed, disabled) {
    for (const [id, button] of this.buttons) {
      if (id in pressed) button.setAttribute("aria-pressed", String(pressed[id]));
      if (id in disabled) button.disabled = disabled[id];
    }
    const expand = this.buttons.get("expand");
    if (expand && "expand" in pressed) {
      expand.innerHTML = icon(pressed.expand ? "shrink" : "expand");
      expand.title = pressed.expand ? say("Back to the node (Esc)") : `${ACTIONS.expand.title} (X)`;
    }
  }
}
