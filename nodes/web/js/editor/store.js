/**
 * The document that is edited, with its history and what is selected.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/document.js").Reference} Reference
 */

import { itemAt } from "../scene/document.js";
import { History } from "../scene/history.js";

export class Store {
  /**
   * @param {SceneDocument} document
   * @param {() => void} onShow  something else is to be seen
   * @param {() => void} onCommit  there is a new document to keep
   */
  constructor(document, onShow, onCommit) {
    this.history = new History(document);
    this.document = document;
    /** @type {Reference | null} */
    this.selection = null;
    this.onShow = onShow;
    this.onCommit = onCommit;
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} [selection]  unchanged where left out
   * @param {string} [key]  steps of one key in a row are one step to undo
   */
  commit(document, selection = this.selection, key = "") {
    this.history.push(document, key);
    this.#settle(selection, true);
  }

  /** @param {SceneDocument} document shown, but not yet a step to undo */
  propose(document) {
    this.document = document;
    this.onShow();
  }

  /** @param {Reference | null} reference */
  select(reference) {
    this.selection = reference;
    this.onShow();
  }

  undo() {
    if (this.history.undo()) this.#settle(this.selection, true);
  }

  redo() {
    if (this.history.redo()) this.#settle(this.selection, true);
  }

  /**
   * A document from outside, which begins a history of its own.
   *
   * @param {SceneDocument} document
   */
  load(document) {
    this.history = new History(document);
    this.#settle(null);
  }

  /**
   * @param {Reference | null} selection
   * @param {boolean} [changed]  whether it is to be kept
   */
  #settle(selection, changed = false) {
    this.document = this.history.present;
    this.selection = itemAt(this.document, selection) ? selection : null;
    // First what the server must hear of, because that takes its time.
    if (changed) this.onCommit();
    this.onShow();
  }
}
