/**
 * The parts of an editor on the page, and what they tell it.
 *
 * @typedef {import("./editor.js").Editor} Editor
 */

import { say } from "../host/words.js";
import { element } from "../panels/elements.js";
import { Inspector } from "../panels/inspector.js";
import { LayerList } from "../panels/layer_list.js";
import { STYLE } from "../panels/style.js";
import { Timeline } from "../panels/timeline.js";
import { ACTIONS, Toolbar } from "../panels/toolbar.js";
import { Stage } from "../stage/stage.js";

/** @param {Editor} editor */
export function layout(editor) {
  const { groups, moves } = editor.options;
  const toolbar = new Toolbar(groups, (id) => editor.commands.run(id));
  const place = element("div", { className: "physanimator-stage" });
  const stage = stageIn(editor, place);
  /** @type {HTMLElement} */
  const status = element("div", { className: "physanimator-status" }, [saidOf(groups), element("span")]);
  place.append(editor.notes.root);
  for (const type of ["pointermove", "pointerleave"]) place.addEventListener(type, (/** @type {Event} */ event) => editor.notes.makeWay(/** @type {PointerEvent} */ (event)));
  const inspector = new Inspector({
    change: (reference, changes, key) => editor.change(reference, changes, key),
    redrawRegion: (kind) => editor.commands.redrawRegion(kind),
    brushSize: (radius) => editor.commands.setBrush(radius),
    chooseBody: (target) => editor.chooseBody(target.name, target.number),
  });
  const layerList = new LayerList({
    choose: (layer) => editor.choose(layer?.name ?? ""),
    look: (layer) => editor.commands.look(layer),
    move: (layer, moves) => editor.commands.move(layer, moves),
    make: (layer, preset) => editor.commands.make(layer, preset),
    attach: (layer, attach) => editor.commands.attach(layer, attach),
    place: (layer, places) => editor.commands.place(layer, places),
  });
  const side = element("div", { className: "physanimator-side" }, [layerList.root, inspector.root]);
  const timeline = new Timeline({
    toggle: () => editor.commands.run("play"),
    loop: () => editor.commands.run("loop"),
    seek: (frame) => editor.commands.seek(frame),
    length: (frames) => editor.commands.setLength(frames),
    select: (reference) => editor.select(reference),
    retime: (reference, item, done) => editor.commands.retime(reference, item, done),
  });
  const title = element("h3", { className: "physanimator-title" }, [editor.options.title ?? ""]);
  toolbar.root.prepend(title);
  const rows = [toolbar.root, place, status, side, ...(moves ? [timeline.root] : [])];
  /** @type {HTMLElement} */
  const frame = element("div", { className: "physanimator-frame" }, rows);
  const onclose = () => editor.commands.shrink();
  /** @type {HTMLDialogElement} */
  const dialog = element("dialog", { className: "physanimator-dialog", "aria-label": editor.options.title, onclose });
  const style = element("style", { textContent: STYLE });
  /** @type {HTMLElement} */
  const root = element("div", { className: "physanimator-editor", "data-capture-wheel": "true" }, [style, frame, dialog]);
  return { toolbar, stage, inspector, layerList, timeline, status, frame, dialog, root };
}

/**
 * Where it is said what the tool does, or what else is seen: as high as the longest of these texts needs, so that the picture stays where it is
 * when another tool is chosen.
 *
 * @param {string[][]} groups  of the editor's actions
 */
function saidOf(groups) {
  const tools = groups.flat().filter((id) => ACTIONS[id].tool).map((id) => ACTIONS[id].title);
  const texts = [...tools, say("The frames of the last run")];
  return element("span", { className: "physanimator-said" }, [element("span"), ...texts.map((text) => element("span", { "aria-hidden": "true" }, [text]))]);
}

/**
 * @param {Editor} editor
 * @param {HTMLElement} place
 */
function stageIn(editor, place) {
  return new Stage(place, editor.document, {
    down: (point, event) => editor.press(point, event),
    move: (point, event) => editor.tool.move(point, event),
    up: (point, event) => editor.tool.up(point, event),
    hover: (point) => editor.hover(point),
    cancel: () => editor.tool.cancel(),
    double: () => editor.tool.finish(),
    redraw: () => editor.redraw(),
  });
}
