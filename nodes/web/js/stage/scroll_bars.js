/**
 * Bars beside a picture that reaches beyond the stage: how much of it is seen, and a handle to go elsewhere.
 *
 * @typedef {import("../scene/geometry.js").View} View
 */

import { element } from "../panels/elements.js";

/** Shortest handle that can be taken hold of, in lengths of its bar. */
const SHORTEST = 0.08;

const WAYS = /** @type {const} */ ({
  across: { position: "clientX", side: "width", edge: "left" },
  down: { position: "clientY", side: "height", edge: "top" },
});

export class ScrollBars {
  /** @param {(dx: number, dy: number) => void} onScroll  by so much of the stage [CSS px], to the right and down */
  constructor(onScroll) {
    this.bars = [bar("across", (d) => onScroll(d, 0)), bar("down", (d) => onScroll(0, d))];
  }

  get roots() {
    return this.bars.map((one) => one.root);
  }

  /**
   * @param {View} view
   * @param {{width: number, height: number}} size  of the picture [px]
   * @param {number} across  of the stage [CSS px]
   * @param {number} down
   */
  show(view, { width, height }, across, down) {
    this.bars[0].show(-view.x, width * view.scale, across);
    this.bars[1].show(-view.y, height * view.scale, down);
  }
}

/**
 * @param {"across" | "down"} way
 * @param {(distance: number) => void} onScroll
 */
function bar(way, onScroll) {
  const { position, side, edge } = WAYS[way];
  const handle = element("div", { className: "physanimator-handle" });
  /** @type {HTMLElement} */
  const root = element("div", { className: "physanimator-scroll", "data-way": way, "aria-hidden": "true", hidden: true }, [handle]);
  /** Distance on the stage for the whole bar, and for a pixel of the window while it is held; where the pointer was. */
  let [far, times, last, held] = [1, 1, 0, -1];
  root.addEventListener("pointerdown", (event) => {
    if (event.button) return;
    // The window shows the graph larger or smaller than it is laid out.
    times = far / (root.getBoundingClientRect()[side] || 1);
    const { [edge]: begin, [side]: end } = handle.getBoundingClientRect();
    // Beside the handle: there at once.
    if (event.target !== handle) onScroll((event[position] - begin - end / 2) * times);
    [last, held] = [event[position], event.pointerId];
    root.setPointerCapture(held);
    event.preventDefault();
  });
  root.addEventListener("pointermove", (event) => {
    if (event.pointerId !== held) return;
    onScroll((event[position] - last) * times);
    last = event[position];
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"])) root.addEventListener(name, () => (held = -1));
  return {
    root,
    /**
     * @param {number} from  where the stage begins on the picture [CSS px]
     * @param {number} length  of the picture
     * @param {number} room  of the stage
     */
    show(from, length, room) {
      root.hidden = length <= room;
      if (root.hidden) return;
      const share = Math.max(room / length, SHORTEST);
      const at = Math.min(Math.max(from / (length - room), 0), 1) * (1 - share);
      far = (length - room) / (1 - share);
      const [long, begin] = [`${100 * share}%`, `${100 * at}%`];
      if (handle.style[side] !== long) handle.style[side] = long;
      if (handle.style[edge] !== begin) handle.style[edge] = begin;
    },
  };
}
