/**
 * What the pointer does on the picture. A tool is told where the pointer goes and changes the scene through the editor.
 *
 * @typedef {import("../scene/document.js").Item} Item
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 *
 * @typedef {object} Draft  what is being drawn and is not yet in the scene
 * @property {string} [colour]
 * @property {Point[]} [path]
 * @property {boolean} [closed]
 * @property {{at: Point, radius: number}} [circle]
 * @property {import("../scene/masks.js").Bitmap} [bitmap]
 *
 * @typedef {object} Desk  what a tool may use of the editor
 * @property {SceneDocument} document
 * @property {Reference | null} selection
 * @property {number} pixel  size of a pixel of the screen [px of the picture]
 * @property {number} brushRadius  [px]
 * @property {number} part  to which a point belongs that is picked
 * @property {() => void} newPart  the next point begins another part
 * @property {Reference | null} replacing  rig point whose region is to be drawn anew
 * @property {(document: SceneDocument, selection?: Reference | null, key?: string) => void} commit
 * @property {(document: SceneDocument) => void} propose  show without making it a step to undo
 * @property {(reference: Reference | null) => void} select
 * @property {(point: Point) => void} chooseAt  select the layer that moves there
 * @property {(sentence: string) => void} say
 * @property {() => void} redraw
 */

export class Tool {
  /**
   * @param {Desk} desk
   * @param {string} id
   */
  constructor(desk, id) {
    this.desk = desk;
    this.id = id;
    /** @type {Draft | null} */
    this.draft = null;
    /** What the pointer looks like over the picture. */
    this.cursor = "crosshair";
  }

  /**
   * @param {Point} point  [px of the picture]
   * @param {PointerEvent} event
   */
  down(point, event) {}

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  move(point, event) {}

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  up(point, event) {}

  /**
   * The pointer passes without being pressed.
   *
   * @param {Point} point
   */
  hover(point) {}

  /** @param {Draft | null} draft  what is being drawn from now on */
  sketch(draft) {
    this.draft = draft;
    this.desk.redraw();
  }

  /** Give up what is being drawn. */
  cancel() {
    this.sketch(null);
  }

  /** End what is being drawn, where it takes several clicks. */
  finish() {}
}
