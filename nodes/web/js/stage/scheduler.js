/** Draws at most once in an animation frame, however often it is asked to. */
export class Scheduler {
  /**
   * @param {(now: number, asked: boolean) => boolean} draw  is told whether it was asked for, or only goes on; returns
   *   whether to go on in the next frame
   * @param {(callback: (now: number) => void) => number} [frame]
   */
  constructor(draw, frame = (callback) => requestAnimationFrame(callback)) {
    this.draw = draw;
    this.frame = frame;
    this.waiting = false;
    this.asked = false;
    this.stopped = false;
    this.requested = 0;
    this.drawn = 0;
  }

  request() {
    this.requested += 1;
    this.asked = true;
    this.#wait();
  }

  #wait() {
    if (this.waiting || this.stopped) return;
    this.waiting = true;
    this.frame((now) => {
      const { asked } = this;
      this.waiting = this.asked = false;
      if (this.stopped) return;
      this.drawn += 1;
      if (this.draw(now, asked)) this.#wait();
    });
  }

  stop() {
    this.stopped = true;
  }
}
