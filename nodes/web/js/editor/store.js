/**
 * The document that is edited, with its history and what is selected.
 *
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 * @typedef {import("../scene/document.js").Reference} Reference
 *
 * @typedef {object} StoreListener
 * @property {() => void} show  something else is to be seen
 * @property {() => void} showSoon  the same, where more of it may follow at once
 * @property {() => void} keep  there is a new document to keep
 */

import { itemAt } from "../scene/document.js";
import { History } from "../scene/history.js";

export class Store {
  /**
   * @param {SceneDocument} document
   * @param {StoreListener} listener
   */
  constructor(document, listener) {
    this.history = new History(document);
    this.document = document;
    /** @type {Reference | null} */
    this.selection = null;
    this.listener = listener;
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
    this.listener.showSoon();
  }

  /** @param {Reference | null} reference */
  select(reference) {
    this.selection = reference;
    this.listener.show();
  }

  /**
   * Change all that there is, the steps to undo as well: what is found out about the picture is no step.
   *
   * @param {(document: SceneDocument) => SceneDocument} change
   * @param {Reference | null} selection
   */
  amend(change, selection) {
    this.history.amend(change);
    this.#settle(selection, true);
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
    if (changed) this.listener.keep();
    this.listener.show();
  }
}
