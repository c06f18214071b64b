/**
 * Shortcuts, while the editor has the focus.
 *
 * @param {KeyboardEvent} event
 * @returns {string} the action's id, or empty
 */
export function actionOf(event) {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (event.ctrlKey || event.metaKey) return event.altKey ? "" : withControl(key, event.shiftKey);
  if (event.altKey) return "";
  return PLAIN[key] ?? "";
}

/** @type {Record<string, string>} */
const PLAIN = {
  v: "select", q: "query-positive", n: "query-negative", w: "wind", r: "repel", a: "attract", p: "pin", l: "path", s: "wave",
  c: "region-circle", g: "region-polygon", b: "region-brush", f: "stiffness", e: "erase", t: "hold",
  Delete: "delete", Backspace: "delete", 0: "fit", "+": "zoom-in", "=": "zoom-in", "-": "zoom-out",
  m: "mesh", h: "items", i: "panel", x: "expand", "[": "brush-smaller", "]": "brush-larger",
  PageUp: "page-back", PageDown: "page-on", ",": "frame-back", ".": "frame-on", Enter: "finish", Escape: "cancel",
  ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down",
};

/**
 * @param {string} key
 * @param {boolean} shift
 */
function withControl(key, shift) {
  if (key === "z") return shift ? "redo" : "undo";
  if (key === "y") return "redo";
  return key === "d" ? "duplicate" : "";
}

/** Combinations with Ctrl that the host would apply to the node; with the focus in here they must not reach it. */
const GUARDED = new Set(["a", "c", "v", "x", "b", "m", "g"]);

/**
 * Whether a key must stay in the editor: everything but the host's own commands, such as Ctrl+Enter and Ctrl+S.
 *
 * @param {KeyboardEvent} event
 */
export function staysInside(event) {
  return !(event.ctrlKey || event.metaKey) || GUARDED.has(event.key.toLowerCase());
}

/**
 * Whether the host undoes by itself where the focus is; then it must not be undone twice.
 *
 * @param {EventTarget | null} target
 */
export function hostUndoes(target) {
  return !["INPUT", "TEXTAREA"].includes(/** @type {any} */ (target)?.tagName);
}

/** @param {EventTarget | null} target whether somebody types there */
export function isTyping(target) {
  const tag = /** @type {any} */ (target)?.tagName;
  const type = /** @type {any} */ (target)?.type;
  const writable = type !== "checkbox" && type !== "range" && !(/** @type {any} */ (target)?.readOnly);
  return tag === "TEXTAREA" || tag === "SELECT" || (tag === "INPUT" && writable);
}
