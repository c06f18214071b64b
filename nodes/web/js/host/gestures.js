/**
 * Who a wheel or two fingers belong to: the editor that is worked with, or the graph behind it.
 */

import { isUsed } from "../panels/elements.js";

/**
 * @param {any} app  the host's
 * @param {any} node
 * @param {HTMLElement} root  of the editor
 */
export function shareGestures(app, node, root) {
  // The LiteGraph canvas lies beside its widgets and hears nothing of their wheel; the Vue canvas is around them.
  root.addEventListener("wheel", (event) => {
    if (isUsed(root) || root.closest("[data-node-id]")) return;
    event.preventDefault();
    app.canvas.processMouseWheel(event);
  }, { passive: false });
  keepView(app, node, root);
}

/**
 * The host zooms the graph wherever two fingers are, and hears of them first: what it has done is taken back.
 *
 * @param {any} app
 * @param {any} node
 * @param {HTMLElement} root
 */
function keepView(app, node, root) {
  /** @type {{scale: number, offset: number[]} | null} */
  let view = null;
  const take = () => {
    const { scale, offset } = app.canvas.ds;
    view = { scale, offset: [...offset] };
  };
  const giveBack = (/** @type {TouchEvent} */ event) => {
    if (!view || event.touches.length < 2) return;
    app.canvas.ds.scale = view.scale;
    [app.canvas.ds.offset[0], app.canvas.ds.offset[1]] = view.offset;
    node.graph?.setDirtyCanvas?.(true, true);
  };
  root.addEventListener("touchstart", take, { passive: true });
  root.addEventListener("touchmove", giveBack, { passive: true });
}
