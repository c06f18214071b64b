/**
 * Options of the nodes' choices, and tooltips of the inputs that a choice brings, in the user's language. The host itself
 * translates names and all other tooltips.
 */

import { say, translates } from "./words.js";

/**
 * Let the widgets of a type of node speak the user's language, also those that come later.
 *
 * @param {any} nodeType  the host's class
 */
export function translateWidgets(nodeType) {
  if (!translates()) return;
  const before = nodeType.prototype.addWidget;
  nodeType.prototype.addWidget = function (/** @type {any[]} */ ...args) {
    const widget = before.apply(this, args);
    translateWidget(widget);
    // Where another widget brings it, the host gives it its tooltip a moment later.
    queueMicrotask(() => translateWidget(widget));
    return widget;
  };
}

/** @param {any} widget */
export function translateWidget(widget) {
  if (widget?.tooltip) widget.tooltip = say(widget.tooltip);
  const values = widget?.options?.values;
  // With labels a list of files would lose its search.
  if (!Array.isArray(values) || values.every((value) => say(String(value)) === String(value))) return;
  widget.options.getOptionLabel = (/** @type {unknown} */ value) => (value === null || value === undefined ? "" : say(String(value)));
}
