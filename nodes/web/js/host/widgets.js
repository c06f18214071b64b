/** What the pack's own widgets have in common. */

/** @param {any} value the widget whose text the editor shows */
export function hide(value) {
  value.hidden = true;
  value.options ??= {};
  value.options.hidden = true;
}

/**
 * Put a part of the page into a node: as wide as the node, neither saved nor shown once more in the host's side panel.
 *
 * @param {any} node
 * @param {string} name
 * @param {HTMLElement} root
 * @param {number} shortest  [px]
 */
export function embed(node, name, root, shortest) {
  const widget = node.addDOMWidget(name, name, root, { serialize: false, hideOnZoom: false, hideInPanel: true, getMinHeight: () => shortest });
  // A widget that is only shown must not be saved: it would shift the values of all that come after it.
  widget.serialize = false;
  // Side panels that show every widget write their own width here, which would be its width in the node, too.
  Object.defineProperty(widget, "width", { configurable: true, get: () => undefined, set: () => {} });
  return widget;
}

/**
 * Tell the host that a value has changed, so that it can be undone.
 *
 * @param {any} app
 * @param {any} node
 * @param {any} value
 */
export function tell(app, node, value) {
  value.callback?.(value.value);
  // The graph itself looks as before; to draw it anew would keep the first moving frame waiting.
  const tracker = app.extensionManager?.workflow?.activeWorkflow?.changeTracker;
  if (tracker?.captureCanvasState) tracker.captureCanvasState();
  else if (tracker?.checkState) tracker.checkState();
  else node.graph?.change?.();
}

/**
 * @param {any} node
 * @param {string} name
 * @param {(argument: any) => void} more
 */
export function chain(node, name, more) {
  const before = node[name];
  node[name] = function (/** @type {any[]} */ ...args) {
    const result = before?.apply(this, args);
    more(args[0]);
    return result;
  };
}
