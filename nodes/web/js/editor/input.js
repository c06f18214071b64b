/**
 * Keyboard, clipboard and dropped files; and nothing of it reaches the graph behind the editor by accident.
 *
 * @typedef {import("./editor.js").Editor} Editor
 */

import { say } from "../host/words.js";
import { itemAt } from "../scene/document.js";
import { sideOf } from "../scene/items.js";
import { moved } from "../scene/shapes.js";
import { copied, pasted } from "./clipboard.js";
import { isUsed } from "../panels/elements.js";
import { actionOf, hostUndoes, isTyping, staysInside } from "./keys.js";
import { mayHoldPicture, pictureIn } from "./pictures.js";

const POINTER_EVENTS = ["pointerdown", "pointermove", "pointerup", "mousedown", "mousemove", "click", "dblclick", "contextmenu"];

/** @param {Editor} editor */
export function listenTo(editor) {
  const { root } = editor;
  for (const name of POINTER_EVENTS) root.addEventListener(name, (/** @type {Event} */ event) => event.stopPropagation());
  // Over an editor that nobody works with the wheel belongs to the graph; older Vue canvases go by this mark alone.
  const marked = () => (root.dataset.captureWheel = String(isUsed(root)));
  // They ask before the wheel comes here.
  for (const name of ["focusin", "focusout", "pointerenter"]) root.addEventListener(name, marked);
  root.addEventListener("wheel", (/** @type {WheelEvent} */ event) => isUsed(root) && event.stopPropagation());
  root.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => onKeyDown(editor, event));
  root.addEventListener("keyup", (/** @type {KeyboardEvent} */ event) => onKeyUp(editor, event));
  root.addEventListener("focusout", () => (editor.stage.spaceHeld = false));
  for (const name of ["focusout", "pointerleave"]) root.addEventListener(name, () => editor.tell());
  root.addEventListener("copy", (/** @type {ClipboardEvent} */ event) => onCopy(editor, event));
  root.addEventListener("cut", (/** @type {ClipboardEvent} */ event) => onCopy(editor, event) && editor.commands.run("delete"));
  root.addEventListener("paste", (/** @type {ClipboardEvent} */ event) => onPaste(editor, event));
  root.addEventListener("dragover", (/** @type {DragEvent} */ event) => mayHoldPicture(event.dataTransfer) && take(event));
  root.addEventListener("drop", (/** @type {DragEvent} */ event) => usePicture(editor, pictureIn(event.dataTransfer), event));
  if (editor.options.moves) root.addEventListener("pointerenter", () => editor.live.client.warmUp());
  editor.toolbar.root.addEventListener("click", (/** @type {MouseEvent} */ event) => {
    // After a click of the mouse the keys belong to the picture; who goes by keyboard stays where they are.
    if (event.detail) editor.stage.focus();
  });
}

/** @param {Event} event that is dealt with here */
function take(event) {
  event.preventDefault();
  event.stopPropagation();
}

/**
 * @param {Editor} editor
 * @param {KeyboardEvent} event
 */
function onKeyDown(editor, event) {
  if (staysInside(event)) event.stopPropagation();
  // A slider has the keys that move it.
  if (/** @type {any} */ (event.target)?.type === "range" && /^(Arrow|Home|End|Page)/.test(event.key)) return;
  const action = actionOf(event);
  const typing = isTyping(event.target);
  if ((action === "undo" || action === "redo") && hostUndoes(event.target)) return;
  if (typing && action !== "undo" && action !== "redo" && event.key !== "Escape") return;
  const onButton = /** @type {any} */ (event.target)?.tagName === "BUTTON";
  if (event.key === " " && !onButton) {
    take(event);
    if (!event.repeat) Object.assign(editor.stage, { spaceHeld: true, panned: false });
    return;
  }
  if (typing && event.key === "Escape") {
    editor.stage.focus();
    take(event);
  } else if (action && !(onButton && action === "finish") && editor.commands.run(action, event.shiftKey)) take(event);
}

/**
 * @param {Editor} editor
 * @param {KeyboardEvent} event
 */
function onKeyUp(editor, event) {
  if (event.key !== " " || !editor.stage.spaceHeld) return;
  editor.stage.spaceHeld = false;
  // Space held down pans; tapped, it plays.
  if (!editor.stage.panned && editor.options.moves) editor.commands.run("play");
}

/**
 * @param {Editor} editor
 * @param {ClipboardEvent} event
 */
function onCopy(editor, event) {
  if (isTyping(event.target)) return false;
  take(event);
  const item = itemAt(editor.document, editor.selection);
  if (!item || !editor.selection) return false;
  event.clipboardData?.setData("text/plain", copied(editor.selection.list, item));
  return true;
}

/**
 * @param {Editor} editor
 * @param {ClipboardEvent} event
 */
function onPaste(editor, event) {
  if (isTyping(event.target)) {
    event.stopPropagation();
    return;
  }
  const found = pasted(event.clipboardData?.getData("text/plain"));
  if (!found) {
    usePicture(editor, pictureIn(event.clipboardData), event);
    event.stopPropagation();
    return;
  }
  take(event);
  const step = Math.round(sideOf(editor.document) * 0.02);
  editor.commands.add(found.list, moved(editor.document, found.item, step, step));
}

/**
 * A picture to draw on until the graph gives one; the graph itself stays as it is.
 *
 * @param {Editor} editor
 * @param {File | null} file
 * @param {Event} event
 */
function usePicture(editor, file, event) {
  if (!file) return;
  take(event);
  if (editor.options.picks?.takePicture) return editor.options.picks.takePicture(file);
  editor.backdrop.forgetRun();
  editor.backdrop.setPicture(URL.createObjectURL(file));
  editor.say(say("This picture is only drawn on. Connect a Load Image node to animate it."));
}
