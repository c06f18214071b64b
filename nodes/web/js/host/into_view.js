/**
 * A new node where its user can see it: the picture in it is large, and hosts put nodes down where there was a double
 * click, on a small screen with half of it out of sight.
 *
 * @typedef {{left: number, top: number, right: number, bottom: number}} Box
 * @typedef {{scale: number, x: number, y: number}} View  what lies at (a, b) of the graph is seen at ((a + x) * scale, (b + y) * scale)
 */

/** Around the node, where hosts have buttons over the canvas [px]. */
const ROOM = { side: 12, above: 56, below: 12 };
/** A node that is too large is shown no smaller than this: what lies at its lower end, its picture, matters most. */
const SMALLEST = 0.5;
/** Time from one look at the node to the next, and after which it has its size [ms]. */
const LOOKS = 100;
const SETTLED = 300;

/**
 * The view nearest to the one there is in which a node is seen whole.
 *
 * @param {View} view
 * @param {Box} node  in the graph
 * @param {Box} free  the part of the canvas that nothing covers [px]
 * @returns {View}
 */
export function withNode(view, node, free) {
  const [left, right] = [free.left + ROOM.side, free.right - ROOM.side];
  const [top, bottom] = [free.top + ROOM.above, free.bottom - ROOM.below];
  const fits = Math.min((right - left) / (node.right - node.left), (bottom - top) / (node.bottom - node.top));
  const scale = Math.min(view.scale, Math.max(SMALLEST, fits));
  // A smaller view keeps the middle of the window where it is.
  const kept = (/** @type {number} */ offset, /** @type {number} */ middle) => offset + middle / scale - middle / view.scale;
  let [x, y] = [kept(view.x, (left + right) / 2), kept(view.y, (top + bottom) / 2)];
  x = Math.max(Math.min(x, right / scale - node.right), left / scale - node.left);
  y = Math.min(Math.max(y, top / scale - node.top), bottom / scale - node.bottom);
  return { scale, x, y };
}

/**
 * Bring a node into view that a person adds, once it has been put down; one that comes with a workflow or from the
 * clipboard stays where it is.
 *
 * @param {any} app  the host's
 * @param {any} node
 * @param {() => boolean} opened  whether it has come with a workflow
 */
export function bringIntoView(app, node, opened) {
  const begun = performance.now();
  const looks = setInterval(() => {
    if (opened() || !node.graph) return clearInterval(looks);
    // Newer hosts have a new node follow the pointer until a click.
    if (node.flags?.ghost || performance.now() - begun < SETTLED) return;
    clearInterval(looks);
    const { canvas } = app;
    const seen = canvas?.graph === node.graph && windowOf(canvas.canvas);
    if (!seen) return;
    const { ds } = canvas;
    const [left, top, across, down] = node.boundingRect ?? [...node.pos, ...node.size];
    const view = withNode({ scale: ds.scale, x: ds.offset[0], y: ds.offset[1] }, { left, top, right: left + across, bottom: top + down }, seen);
    ds.scale = view.scale;
    ds.offset = [view.x, view.y];
    canvas.setDirty(true, true);
  }, LOOKS);
}

/**
 * @param {HTMLCanvasElement} canvas
 * @returns {Box | null} null where it is not on the page
 */
function windowOf(canvas) {
  const whole = canvas.getBoundingClientRect();
  const { left, top, right, bottom } = document.querySelector(".graph-canvas-panel")?.getBoundingClientRect() ?? whole;
  const map = document.querySelector(".litegraph-minimap, .minimap-main-container")?.getBoundingClientRect();
  // The map of the graph lies in the lower right corner; beside it there is room in all but the smallest windows.
  const end = map && map.width && map.left - left > (right - left) / 2 ? Math.min(map.left, right) : right;
  return end > left && bottom > top ? { left: left - whole.left, top: top - whole.top, right: end - whole.left, bottom: bottom - whole.top } : null;
}
