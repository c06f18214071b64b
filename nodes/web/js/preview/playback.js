/**
 * Where a preview stands: frames as they arrive, and which of them to show at which moment.
 *
 * @typedef {import("./records.js").Frame} Frame
 * @typedef {import("./records.js").Header} Header
 */
export class Playback {
  constructor() {
    /** @type {Header | null} */
    this.header = null;
    /** @type {Frame[]} */
    this.frames = [];
    /** @type {Frame | null} of the motion before, on the screen until the new one has a frame */
    this.last = null;
    /** Whether a new motion has been asked for; until it comes, the old one stands still and leaves it the processor. */
    this.waiting = false;
    this.playing = true;
    this.looping = true;
    /** Position [frames]; a fraction while playing. */
    this.position = 0;
    this.moment = 0;
    this.duration = 72;
    this.frameRate = 24;
  }

  /**
   * @param {Header} header  of a new motion; it begins where the old one stood still or from the start
   * @param {number} now  [ms]
   */
  begin(header, now) {
    this.last = this.shown;
    this.waiting = false;
    this.header = header;
    this.frames = [];
    this.frameRate = header.frame_rate;
    this.duration = header.frames;
    if (!this.playing) return;
    // The drawing itself was on the screen until now; what comes next moves.
    this.position = 1;
    this.moment = now;
  }

  clear() {
    this.last = null;
    this.waiting = false;
    this.header = null;
    this.frames = [];
  }

  /** @param {Frame} frame */
  add(frame) {
    this.frames[frame.number] = frame;
  }

  /** The frame at the position, or the last one before it that has arrived. */
  get shown() {
    if (!this.frames.length) return this.last;
    return this.frames[Math.min(Math.floor(this.position), this.frames.length - 1)] ?? null;
  }

  get seconds() {
    return this.position / this.frameRate;
  }

  /** Whether there is a motion that can be played. */
  get moving() {
    return this.header !== null && this.frames.length + (this.last ? 1 : 0) > 1;
  }

  /** Whether it plays, or goes on as soon as a new motion has come. */
  get plays() {
    return this.playing && this.moving;
  }

  /** Whether the position goes on by itself. */
  get moves() {
    return this.playing && this.frames.length > 1 && !this.waiting;
  }

  /**
   * Go on to another moment.
   *
   * @param {number} now  [ms]
   * @returns {boolean} whether there is more to show
   */
  advance(now) {
    const passed = Math.min((now - this.moment) / 1000, 0.25);
    this.moment = now;
    if (!this.moves) return false;
    const next = this.position + passed * this.frameRate;
    // Where frames arrive more slowly than they are shown, the last one waits.
    if (this.frames.length < this.duration) this.position = Math.min(next, this.frames.length - 1);
    else if (next < this.duration) this.position = next;
    else if (this.looping) this.position = next % this.duration;
    else this.#stop();
    return this.playing;
  }

  #stop() {
    this.position = this.duration - 1;
    this.playing = false;
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing && !this.looping && this.position >= this.duration - 1) this.position = 0;
  }

  /** @param {number} frame */
  seek(frame) {
    this.playing = false;
    this.position = Math.min(Math.max(Math.round(frame), 0), this.duration - 1);
  }
}
