/**
 * What is drawn on the still layer and on the overlay.
 *
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/geometry.js").View} View
 * @typedef {import("../preview/records.js").Mesh} Mesh
 * @typedef {{reference: Reference, item: import("../scene/document.js").Item}} Placed
 *
 * @typedef {object} Picture  all that one drawing shows
 * @property {SceneDocument} document
 * @property {SceneDocument} settled  as it was before what is being changed at this moment
 * @property {Reference | null} selection
 * @property {View} view
 * @property {CanvasImageSource | null} background  null where the moving mesh is shown instead
 * @property {Mesh | null} restingMesh  to be drawn where it was before anything moved
 * @property {Mesh | null} movingMesh  to be drawn here, where the film cannot show it
 * @property {import("../preview/records.js").Frame | null} frame
 * @property {number} unit  of the frame [px]
 * @property {import("./tool.js").Draft | null} draft
 * @property {{at: Point, radius: number} | null} brush
 * @property {import("../editor/picking.js").Cut[] | null} cuts  parts that are picked
 * @property {boolean} itemsShown
 * @property {boolean} particlesShown
 * @property {{box: [number, number, number, number], mesh: Mesh | null} | null} outline  of the selected layer
 */

import { toStage } from "../scene/geometry.js";
import { COLOURS } from "./colours.js";
import { ItemPainter, moves } from "./item_painter.js";
import { draftMask } from "./tints.js";

/** Particles up to which each shows how far it reaches: of more, the circles hide the picture and take long to draw. */
const MOST_REACHES = 40;
const PARTICLES = [COLOURS.wind, COLOURS.repel, COLOURS.attract];

/**
 * The picture, and the items that are not being changed: the selected one above the others.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Picture} shown
 * @param {Placed[]} still
 */
export function drawStill(context, shown, still) {
  const { document, view, selection } = shown;
  const items = new ItemPainter(context, view, document);
  if (shown.background) items.stretched(shown.background, 1);
  for (const cut of shown.cuts ?? []) items.stretched(shown.background ? cut.fill : cut.edge, shown.background ? 0.5 : 0.9);
  frame(context, shown);
  if (shown.restingMesh) wireframe(context, view, shown.restingMesh, null, 1);
  if (!shown.itemsShown) return;
  const chosen = still.find((one) => isChosen(one, selection));
  for (const one of still) if (one !== chosen) items.draw(one.reference, one.item, false);
  if (chosen) items.draw(chosen.reference, chosen.item, true);
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Picture} shown
 * @param {Placed[]} changing
 */
export function drawOverlay(context, shown, changing) {
  const { document, view, selection, movingMesh } = shown;
  const items = new ItemPainter(context, view, document);
  if (movingMesh) wireframe(context, view, movingMesh, shown.frame, shown.unit);
  if (shown.outline?.mesh) wireframe(context, view, shown.outline.mesh, shown.frame, shown.unit);
  else if (shown.outline) box(items, shown.outline.box);
  if (shown.itemsShown) {
    for (const one of changing) items.draw(one.reference, one.item, isChosen(one, selection));
    anchors(items, shown);
  }
  if (shown.frame && shown.particlesShown) particles(items, shown);
  if (shown.draft) draft(items, shown);
  if (shown.brush) {
    items.painter.circle(items.at(shown.brush.at), shown.brush.radius * view.scale, "#fff", { width: 1 });
  }
}

/**
 * Where a layer is that stands still.
 *
 * @param {ItemPainter} items
 * @param {[number, number, number, number]} box
 */
function box({ context, view }, [left, top, width, height]) {
  context.lineWidth = 1;
  context.strokeStyle = "rgba(0, 200, 255, 0.9)";
  context.strokeRect(view.x + left * view.scale, view.y + top * view.scale, width * view.scale, height * view.scale);
}

/**
 * @param {Placed} one
 * @param {Reference | null} selection
 */
function isChosen({ reference }, selection) {
  return selection?.list === reference.list && selection.index === reference.index;
}

/**
 * The rig points that move, where they are at this moment.
 *
 * @param {ItemPainter} items
 * @param {Picture} shown
 */
function anchors(items, { document, frame, unit }) {
  (document.rig_points ?? []).forEach((/** @type {any} */ item, /** @type {number} */ index) => {
    if (!moves(item)) return;
    const known = frame && frame.anchors.length > index * 2 + 1;
    items.anchor(item, known ? [frame.anchors[index * 2] * unit, frame.anchors[index * 2 + 1] * unit] : [0, 0]);
  });
}

/**
 * The edge of the picture, so that its size is seen before there is a picture.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Picture} shown
 */
function frame(context, { document, view }) {
  context.strokeStyle = "rgba(128, 128, 128, 0.6)";
  context.lineWidth = 1;
  context.strokeRect(view.x - 0.5, view.y - 0.5, document.width * view.scale + 1, document.height * view.scale + 1);
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {View} view
 * @param {Mesh} mesh
 * @param {import("../preview/records.js").Frame | null} frame
 * @param {number} unit  of the frame [px]
 */
function wireframe(context, view, { positions, triangles }, frame, unit) {
  /** @type {(vertex: number) => Point} */
  const place = (vertex) => {
    const moved = frame?.displacements;
    const x = positions[vertex * 2] + (moved ? moved[vertex * 2] * unit : 0);
    const y = positions[vertex * 2 + 1] + (moved ? moved[vertex * 2 + 1] * unit : 0);
    return toStage(view, [x, y]);
  };
  context.beginPath();
  for (let i = 0; i < triangles.length; i += 3) {
    const corners = [place(triangles[i]), place(triangles[i + 1]), place(triangles[i + 2])];
    context.moveTo(...corners[2]);
    for (const corner of corners) context.lineTo(...corner);
  }
  context.lineWidth = 0.6;
  context.strokeStyle = "rgba(0, 200, 255, 0.7)";
  context.stroke();
}

/**
 * @param {ItemPainter} items
 * @param {Picture} shown
 */
function particles(items, { frame, unit, view }) {
  const data = frame?.particles ?? [];
  const reachShown = data.length <= 4 * MOST_REACHES;
  for (let i = 0; i + 3 < data.length; i += 4) {
    const colour = PARTICLES[data[i + 3]] ?? COLOURS.wind;
    const at = items.at([data[i] * unit, data[i + 1] * unit]);
    const { context } = items;
    if (reachShown) {
      context.globalAlpha = 0.5;
      items.painter.circle(at, data[i + 2] * unit * view.scale, colour, { width: 0.75 });
      context.globalAlpha = 1;
    }
    items.painter.dot(at, 4, colour);
  }
}

/**
 * @param {ItemPainter} items
 * @param {Picture} shown
 */
function draft(items, { draft: drawn }) {
  const colour = drawn?.colour ?? COLOURS.pin;
  if (drawn?.path) {
    const path = drawn.path.map(items.at);
    items.painter.line(path, colour, { closed: drawn.closed, fill: drawn.closed ? `${colour}30` : "" });
    if (drawn.closed) items.painter.square(path[0], colour);
  }
  if (drawn?.circle) items.painter.circle(items.at(drawn.circle.at), drawn.circle.radius * items.view.scale, colour, { fill: `${colour}30` });
  if (drawn?.bitmap) items.stretched(draftMask(drawn.bitmap, colour), 0.6);
}
