// Clips of one picture play in step: one clock for each group, which the videos follow. Only what is in sight is loaded.
"use strict";

const FRAME = 1 / 24; // s: one press of , or .
const OFF = 0.04; // s: a video that is off by more is set to the clock's time

const reduced = matchMedia("(prefers-reduced-motion: reduce)").matches;
const speed = document.getElementById("speed");
let current = null;

class Group {
  constructor(section) {
    this.videos = [...section.querySelectorAll("video")];
    this.button = section.querySelector("button");
    this.slider = section.querySelector("input");
    this.time = 0;
    this.playing = !reduced;
    this.seen = false;
    this.button.addEventListener("click", () => this.play(!this.playing));
    this.slider.addEventListener("input", () => {
      this.play(false);
      this.seek(Number(this.slider.value) * this.duration);
    });
    section.addEventListener("pointerenter", () => (current = this));
    this.play(this.playing);
  }

  get duration() {
    const known = this.videos.map((video) => video.duration).filter((each) => Number.isFinite(each));
    return known.length ? Math.max(...known) : 0;
  }

  show(seen) {
    this.seen = seen;
    for (const video of this.videos) {
      if (seen && !video.src) {
        video.src = video.dataset.src;
        video.preload = "auto";
        video.addEventListener("loadeddata", () => this.follow(video), { once: true });
      }
    }
  }

  play(playing) {
    this.playing = playing;
    this.button.textContent = playing ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", playing ? "halt" : "play");
    for (const video of this.videos) video.pause();
  }

  seek(time) {
    const length = this.duration;
    this.time = length ? ((time % length) + length) % length : 0;
    this.slider.value = length ? this.time / length : 0;
    for (const video of this.videos) this.follow(video);
  }

  advance(seconds) {
    const ready = this.videos.filter((video) => video.src);
    if (!this.seen || !this.playing || !ready.length || ready.some((video) => video.readyState < 2 && !video.error)) {
      return; // nobody runs ahead of a clip that is still loading
    }
    const before = this.time;
    const length = this.duration;
    this.time += seconds * Number(speed.value);
    if (length && this.time >= length) this.time = 0;
    this.slider.value = length ? this.time / length : 0;
    for (const video of ready) {
      video.playbackRate = Number(speed.value);
      if (video.paused && this.time < video.duration - OFF) video.play().catch(() => {});
      if (this.time < before || Math.abs(video.currentTime - this.time) > OFF) this.follow(video);
    }
  }

  follow(video) {
    if (Number.isFinite(video.duration)) video.currentTime = Math.min(this.time, Math.max(0, video.duration - 0.001));
  }
}

const groups = new Map([...document.querySelectorAll(".group")].map((each) => [each, new Group(each)]));
const watcher = new IntersectionObserver(
  (entries) => {
    for (const entry of entries) groups.get(entry.target).show(entry.isIntersecting);
  },
  { rootMargin: "200px" },
);
for (const section of groups.keys()) watcher.observe(section);

let last = performance.now();
function tick(now) {
  const seconds = Math.min(0.1, (now - last) / 1000);
  last = now;
  for (const group of groups.values()) group.advance(seconds);
  requestAnimationFrame(tick);
}
requestAnimationFrame(tick);

document.getElementById("width").addEventListener("input", (event) => {
  document.documentElement.style.setProperty("--clip", `${event.target.value}px`);
});
document.addEventListener("keydown", (event) => {
  if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName)) return;
  const group = current ?? [...groups.values()].find((each) => each.seen);
  if (!group) return;
  if (event.key === " ") group.play(!group.playing);
  else if (event.key === ",") group.play(false), group.seek(group.time - FRAME);
  else if (event.key === ".") group.play(false), group.seek(group.time + FRAME);
  else return;
  event.preventDefault();
});
