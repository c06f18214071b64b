/**
 * Asks the server for the motion of a scene: a moment after the last change, and the latest request wins.
 *
 * @typedef {import("./records.js").PreviewRecord} PreviewRecord
 * @typedef {import("./records.js").Mesh} Mesh
 * @typedef {(path: string, options?: any) => Promise<Response>} Fetch
 */

import { say } from "../host/words.js";
import { meshOf, RecordReader } from "./records.js";

const SUPERSEDED = "superseded";
/** Changes that follow within this time belong together [ms]. */
const PAUSE = 300;

/** An answer of the server that is a sentence for the user. */
export class Refusal extends Error {
  /**
   * @param {string} message
   * @param {number} status
   */
  constructor(message, status) {
    super(message);
    this.status = status;
  }
}

/** There was no answer at all. */
export class Unanswered extends Error {}

export class PreviewClient {
  /**
   * @param {object} options
   * @param {Fetch} options.fetch  the host's, which knows where the server is
   * @param {string} options.editor  tells this editor from others
   * @param {(record: PreviewRecord) => void} options.onRecord
   * @param {(error: Error) => void} options.onError
   * @param {number} [options.delay]  [ms]
   */
  constructor({ fetch, editor, onRecord, onError, delay = 80 }) {
    this.fetch = fetch;
    this.editor = editor;
    this.onRecord = onRecord;
    this.onError = onError;
    this.delay = delay;
    /** @type {AbortController | null} */
    this.running = null;
    /** @type {any} */
    this.timer = 0;
    this.asked = -Infinity;
    this.warm = false;
  }

  /** Let the server get its solver ready, once; a server that cannot simply takes longer later. */
  warmUp() {
    if (this.warm) return;
    this.warm = true;
    this.fetch("/physanimator/warm-up", { method: "POST" }).catch(() => null);
  }

  /**
   * @param {string} key  of the mesh
   * @param {import("../scene/document.js").SceneDocument} scene
   * @param {number} frames
   */
  request(key, scene, frames) {
    this.cancel();
    // A single change is shown at once; only where one follows the other is the last one waited for.
    const now = performance.now();
    const soon = now - this.asked < PAUSE;
    this.asked = now;
    if (soon) this.timer = setTimeout(() => this.#start(key, scene, frames), this.delay);
    else this.#start(key, scene, frames);
  }

  cancel() {
    clearTimeout(this.timer);
    this.running?.abort();
    this.running = null;
  }

  /**
   * @param {string} key
   * @returns {Promise<Mesh>}
   */
  async mesh(key) {
    const answer = await this.#get(`/physanimator/mesh/${key}`);
    return meshOf(await answer.arrayBuffer());
  }

  /**
   * Pins for each body of a run.
   *
   * @param {string} key
   * @param {string} attach  where to hold them; "found" for where each is found to be held
   * @returns {Promise<import("../scene/holds.js").Hold[]>}
   */
  async holds(key, attach) {
    const answer = await this.#get(`/physanimator/holds/${key}/${attach}`);
    return answer.json();
  }

  /**
   * @param {string} path
   * @returns {Promise<Response>}
   */
  async #get(path) {
    const answer = await this.fetch(path).catch(failed);
    if (!answer.ok) throw await refusal(answer);
    return answer;
  }

  /**
   * @param {string} key
   * @param {object} scene
   * @param {number} frames
   */
  async #start(key, scene, frames) {
    const controller = new AbortController();
    this.running = controller;
    try {
      const answer = await this.fetch("/physanimator/preview", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ editor: this.editor, key, scene, frames }),
        signal: controller.signal,
      }).catch(failed);
      if (!answer.ok) throw await refusal(answer);
      await this.#read(/** @type {ReadableStream<Uint8Array>} */ (answer.body), controller);
    } catch (error) {
      if (this.running === controller) this.onError(/** @type {Error} */ (error));
    }
  }

  /**
   * @param {ReadableStream<Uint8Array>} body
   * @param {AbortController} controller
   */
  async #read(body, controller) {
    const reader = body.getReader();
    const records = new RecordReader();
    for (;;) {
      const { done, value } = await reader.read().catch(failed);
      if (done || this.running !== controller) return;
      for (const record of records.push(value)) {
        if (record.type === "error" && record.error === SUPERSEDED) return;
        this.onRecord(record);
      }
    }
  }
}

/**
 * @param {Response} answer
 * @returns {Promise<Refusal>}
 */
async function refusal(answer) {
  const said = await answer.json().catch(() => null);
  return new Refusal(said?.error ?? say("The server answered {status}.", { status: `${answer.status} ${answer.statusText}` }), answer.status);
}

/**
 * What a browser says of a server that is gone, each in words of its own, in ours.
 *
 * @param {Error} error
 * @returns {never}
 */
export function failed(error) {
  throw error instanceof TypeError ? new Unanswered(say("The server does not answer. Is ComfyUI still running?")) : error;
}
