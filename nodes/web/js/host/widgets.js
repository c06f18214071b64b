/** What the pack's own widgets have in common. */

/** @param {any} value the widget whose text the editor shows */
export function hide(value) {
  value.hidden = true;
  value.options ??= {};
  value.options.hidden = true;
}

/** Times after which a node that was added should be seen [ms]. */
const SEEN_AFTER = [50, 300, 1000];
/** @type {WeakMap<Element, {node: any, name: string}>} what each part of the page belongs to */
const owners = new WeakMap();

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
  owners.set(root, { node, name });
  root.dataset.embedded = name;
  chain(node, "onAdded", () => SEEN_AFTER.forEach((time) => setTimeout(() => takePlace(root), time)));
  return widget;
}

/**
 * Show a part where the same one of a node that is gone is still seen.
 *
 * To undo, the host makes all nodes anew, with the numbers they had. Its Vue canvas takes them for those before, and goes
 * on showing what was in them, which nothing answers any more.
 *
 * @param {HTMLElement} root
 */
export function takePlace(root) {
  const own = owners.get(root);
  if (!own || root.isConnected || !isThere(own.node)) return;
  for (const other of document.querySelectorAll(`[data-embedded="${own.name}"]`)) {
    const before = owners.get(other);
    if (before && before.node.id === own.node.id && !isThere(before.node)) return other.replaceWith(root);
  }
}

/** @param {any} node */
function isThere(node) {
  return node.graph?.getNodeById?.(node.id) === node;
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
