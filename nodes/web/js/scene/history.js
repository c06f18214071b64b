/**
 * Undo and redo over states that are never changed in place.
 *
 * @template T
 */
export class History {
  /**
   * @param {T} present
   * @param {number} limit  how many steps back are kept
   */
  constructor(present, limit = 200) {
    this.present = present;
    this.limit = limit;
    /** @type {T[]} */
    this.past = [];
    /** @type {T[]} */
    this.future = [];
    this.key = "";
  }

  /**
   * @param {T} state
   * @param {string} key  changes of one key in a row are one step, such as typing a number
   */
  push(state, key = "") {
    if (state === this.present) return;
    if (!key || key !== this.key || !this.past.length) this.past.push(this.present);
    if (this.past.length > this.limit) this.past.shift();
    this.future = [];
    this.present = state;
    this.key = key;
  }

  /** @param {(state: T) => T} change  of every state */
  amend(change) {
    this.past = this.past.map(change);
    this.future = this.future.map(change);
    this.present = change(this.present);
  }

  undo() {
    return this.#step(this.past, this.future);
  }

  redo() {
    return this.#step(this.future, this.past);
  }

  /**
   * @param {T[]} from
   * @param {T[]} to
   */
  #step(from, to) {
    const state = from.pop();
    if (state === undefined) return false;
    to.push(this.present);
    this.present = state;
    this.key = "";
    return true;
  }
}
