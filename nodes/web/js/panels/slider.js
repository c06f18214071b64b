/**
 * A slider beside a number: over the values that are usual; a number beyond them is typed.
 *
 * @typedef {import("../scene/fields.js").Field} Field
 *
 * @typedef {object} Scale
 * @property {number} low
 * @property {number} high
 * @property {(share: number) => number} value  at a share of the way, from 0 to 1
 * @property {(value: number) => number} share
 */

import { say } from "../host/words.js";
import { element } from "./elements.js";

const NOTCHES = 1000;
/** What fields offer whose own bounds are far, by their paths. @type {Record<string, [number, number]>} */
const USUAL = {
  strength: [-10, 10], "wind.strength": [0, 10], frame_rate: [1, 60], interval: [0.01, 3], "motion.stretch": [0.5, 2],
  "wind.gust_period": [0.05, 10], "motion.period": [0.05, 10], "contact.thickness": [0.1, 20], start: [0, 10],
  "motion.amplitude": [0, 180], sway_frequency: [0.05, 8], damping: [0, 10], wind_response: [0, 10], root_stiffness: [1, 100],
};

/**
 * @param {Field} field
 * @param {number} value  that it has
 * @param {number} side  the longest of the picture [px]
 * @returns {Scale | null} null where a slider says nothing
 */
export function scaleOf(field, value, side) {
  if (field.kind !== "number" || !Number.isFinite(value)) return null;
  const bounds = usualBounds(field, side);
  if (!bounds) return null;
  const [low, high] = [Math.min(bounds[0], value), Math.max(bounds[1], value)];
  if (field.unit === "×" && low > 0) return bent(low, high, Math.log, Math.exp);
  // Small lengths matter as much as large ones.
  if (low >= 0 && field.unit?.startsWith("px")) return bent(low, high, Math.sqrt, (root) => root * root);
  return bent(low, high, Number, Number);
}

/**
 * @param {Field} field
 * @param {number} side  [px]
 * @returns {[number, number] | null}
 */
function usualBounds({ path, unit, min = -Infinity, max = Infinity }, side) {
  const within = (/** @type {number} */ low, /** @type {number} */ high) => /** @type {[number, number]} */ ([Math.max(low, min), Math.min(high, max)]);
  if (unit === "px") return path === "contact.thickness" ? within(...USUAL[path]) : within(path === "motion.amplitude" ? -side / 4 : 0, side / 2);
  if (unit === "px/s") return within(0, 2 * side);
  if (unit === "×") return within(0.1, 10);
  if (unit === say("degrees") && path !== "motion.amplitude") return within(-180, 180);
  if (USUAL[path]) return within(...USUAL[path]);
  return max - min <= 100 ? [min, max] : null;
}

/**
 * @param {number} low
 * @param {number} high
 * @param {(value: number) => number} to
 * @param {(shown: number) => number} back
 * @returns {Scale}
 */
function bent(low, high, to, back) {
  const [first, last] = [to(low), to(high)];
  return { low, high, value: (share) => back(first + (last - first) * share), share: (value) => (to(value) - first) / (last - first || 1) };
}

/**
 * The slider of a number; each follows the other.
 *
 * @param {Field} field
 * @param {HTMLInputElement} number  the input beside it
 * @param {number} side  [px]
 * @returns {HTMLInputElement[]} none where it would say nothing
 */
export function slidersOf(field, number, side) {
  const scale = scaleOf(field, Number(number.value || NaN), side);
  if (!scale) return [];
  const slider = element("input", { type: "range", className: "physanimator-slide", min: "0", max: String(NOTCHES), step: "1", "aria-label": field.title });
  const follow = () => {
    const value = Number(number.value);
    slider.value = String(Math.round(NOTCHES * scale.share(Math.min(Math.max(value, scale.low), scale.high))));
    slider.setAttribute("aria-valuetext", `${number.value} ${field.unit ?? ""}`.trim());
  };
  const step = field.step ?? 0.01;
  const put = (/** @type {number} */ value) => {
    number.value = String(Math.round(Math.min(Math.max(value, scale.low), scale.high) * 1e6) / 1e6);
    number.dispatchEvent(new Event("input"));
  };
  slider.addEventListener("input", () => put(Math.round(scale.value(Number(slider.value) / NOTCHES) / step) * step));
  slider.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
    const direction = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!direction) return;
    event.preventDefault();
    put(Number(number.value) + direction * step * (event.shiftKey ? 10 : 1));
  });
  number.addEventListener("input", follow);
  follow();
  return [slider];
}
