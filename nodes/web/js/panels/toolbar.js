/**
 * The buttons above the picture: tools, changes, view.
 *
 * @typedef {object} Action
 * @property {string} id  also the name of its icon
 * @property {string} [label]  a word or two beside the icon where there is room
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
  select: { id: "select", label: say("Select"), title: say("Select and drag items, points and handles"), key: "V", tool: true },
  "query-positive": { id: "query-positive", label: say("On it"), title: say("Point on the part"), key: "Q", tool: true },
  "query-negative": { id: "query-negative", label: say("Beside it"), title: say("Point beside the part"), key: "N", tool: true },
  wind: { id: "wind", label: say("Wind"), title: say("Wind: draw where it blows"), key: "W", tool: true },
  repel: { id: "repel", label: say("Repel"), title: say("Repel: draw what pushes away (a click rests)"), key: "R", tool: true },
  attract: { id: "attract", label: say("Attract"), title: say("Attract: draw what pulls closer (a click rests)"), key: "A", tool: true },
  pin: { id: "pin", label: say("Pin"), title: say("Pin: click to hold a spot"), key: "P", tool: true },
  path: { id: "path", label: say("Lead"), title: say("Lead: drag a spot along, as fast as it shall go"), key: "L", tool: true },
  wave: { id: "wave", label: say("Wave"), title: say("Wave: drag as far as it shall swing"), key: "S", tool: true },
  "region-circle": { id: "region-circle", label: say("Circle"), title: say("Held circle: drag from its middle"), key: "C", tool: true },
  "region-polygon": { id: "region-polygon", label: say("Outline"), title: say("Held outline: draw around it, or click its corners"), key: "G", tool: true },
  "region-brush": { id: "region-brush", label: say("Paint"), title: say("Held area: paint it; Alt takes away, [ and ] change the size"), key: "B", tool: true },
  stiffness: { id: "stiffness", label: say("Stiffness"), title: say("Stiffness: paint what is stiffer; Alt takes away, [ and ] change the size"), key: "F", tool: true },
  erase: { id: "erase", label: say("Erase"), title: say("Erase what the pointer passes over"), key: "E", tool: true },
  hold: { id: "hold", label: say("Hold all"), title: say("Hold every body where it is found to be held, instead of its pins"), key: "T" },
  undo: { id: "undo", label: say("Undo"), title: say("Undo"), key: "Ctrl+Z" },
  redo: { id: "redo", label: say("Redo"), title: say("Redo"), key: "Ctrl+Shift+Z" },
  duplicate: { id: "duplicate", label: say("Duplicate"), title: say("Duplicate the selected item"), key: "Ctrl+D" },
  delete: { id: "delete", label: say("Delete"), title: say("Delete the selected item"), key: "Delete" },
  "zoom-out": { id: "zoom-out", title: say("Zoom out"), key: "-" },
  fit: { id: "fit", label: say("Whole picture"), title: say("Show the whole picture"), key: "0" },
  "zoom-in": { id: "zoom-in", title: say("Zoom in"), key: "+" },
  mesh: { id: "mesh", label: say("Mesh"), title: say("Show the mesh"), key: "M", toggle: true },
  items: { id: "items", label: say("Drawing"), title: say("Show what is drawn"), key: "H", toggle: true },
  panel: { id: "panel", label: say("Values"), title: say("Show the values"), key: "I", toggle: true },
  expand: { id: "expand", label: say("Large view"), title: say("Edit in the whole window"), key: "X", toggle: true },
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
    const made = groups.map((group) => element("div", { className: "physanimator-group" }, group.map((id) => this.#button(ACTIONS[id], onAction))));
    const drawing = groups.map((group) => group.some((id) => ACTIONS[id].tool));
    this.tools = element("div", { className: "physanimator-tools" }, made.filter((_, i) => drawing[i]));
    this.actions = element("div", { className: "physanimator-actions" }, made.filter((_, i) => !drawing[i]));
    this.root = element("div", { className: "physanimator-toolbar", role: "toolbar", "aria-label": say("Scene editor") }, [this.tools, this.actions]);
    this.observer = new ResizeObserver(() => this.#label());
    this.observer.observe(this.root);
  }

  /** Words beside the icons, as far as they need no more rows than the icons alone. */
  #label() {
    const { root } = this;
    const across = root.clientWidth;
    if (!across || across === this.across) return;
    this.across = across;
    const down = (/** @type {string} */ labels) => {
      root.dataset.labels = labels;
      return root.offsetHeight;
    };
    const least = down("none");
    const most = ["all", "tools"].find((labels) => down(labels) <= least);
    if (!most) root.dataset.labels = "none";
  }

  release() {
    this.observer.disconnect();
  }

  /**
   * @param {Action} action
   * @param {(id: string) => void} onAction
   */
  #button({ id, label, title, key, tool, toggle }, onAction) {
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
    if (label) button.append(element("span", { className: "physanimator-label" }, [label]));
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
      const label = pressed.expand ? say("Back to the node") : (ACTIONS.expand.label ?? "");
      expand.innerHTML = icon(pressed.expand ? "shrink" : "expand");
      expand.append(element("span", { className: "physanimator-label" }, [label]));
      expand.title = pressed.expand ? say("Back to the node (Esc)") : `${ACTIONS.expand.title} (X)`;
    }
  }
}
