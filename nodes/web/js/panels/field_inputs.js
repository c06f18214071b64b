/**
 * Inputs for the fields of an item.
 *
 * @typedef {import("../scene/fields.js").Field} Field
 * @typedef {(changes: [string, any][], key: string) => void} Change  new values by their paths; undefined removes one
 */

import { say } from "../host/words.js";
import { valueAt } from "../scene/document.js";
import { element } from "./elements.js";
import { slidersOf } from "./slider.js";

/**
 * A label with its input, for one field of an item.
 *
 * @param {Field} field
 * @param {any} item
 * @param {Change} change
 * @param {number} [side]  the longest of the picture [px]
 * @returns {HTMLElement}
 */
export function fieldRow(field, item, change, side = 1280) {
  if (field.kind === "keys") return keysRow(field, item, change);
  const value = valueAt(item, field.path) ?? field.default;
  const inputs = field.kind === "pair" ? pairInputs(field, value, change) : [singleInput(field, value, change)];
  // Without a unit its place stays free, so that the numbers stand below each other.
  const unit = field.unit || ["number", "integer", "pair"].includes(field.kind) ? [element("span", { className: "physanimator-unit" }, [field.unit ?? ""])] : [];
  const caption = element("span", { className: "physanimator-caption" }, [field.title]);
  return element("label", { className: "physanimator-field", title: field.hint, "data-field": field.path }, [
    caption,
    element("span", { className: "physanimator-inputs" }, [...inputs, ...unit]),
    ...(inputs.length === 1 ? slidersOf(field, inputs[0], side) : []),
  ]);
}

/**
 * @param {Field} field
 * @param {any} value
 * @param {Change} change
 */
function singleInput(field, value, change) {
  if (field.kind === "choice") {
    const options = (field.choices ?? []).map((choice) => element("option", { value: choice }, [say(choice)]));
    const choose = (/** @type {Event} */ event) => change([[field.path, /** @type {any} */ (event.target).value]], "");
    const select = element("select", { "aria-label": field.title, onchange: choose }, options);
    select.value = value;
    return select;
  }
  if (field.kind === "boolean") {
    const flip = (/** @type {Event} */ event) => change([[field.path, /** @type {any} */ (event.target).checked]], "");
    return element("input", { type: "checkbox", checked: value, "aria-label": field.title, onchange: flip });
  }
  return numberInput(field, value, (number) => change([[field.path, number]], field.path));
}

/**
 * @param {Field} field
 * @param {[number, number]} value
 * @param {Change} change
 */
function pairInputs(field, value, change) {
  const current = [...value];
  return [0, 1].map((index) =>
    numberInput({ ...field, title: `${field.title} ${"xy"[index]}` }, value[index], (number) => {
      current[index] = number ?? 0;
      change([[field.path, [...current]]], field.path);
    }),
  );
}

/**
 * A number with its bounds; while it cannot be used it is marked, and the scene keeps the last one that could.
 *
 * @param {Pick<Field, "title" | "min" | "max" | "step" | "optional" | "kind">} field
 * @param {number | null | undefined} value
 * @param {(value: number | undefined) => void} onNumber
 * @returns {HTMLInputElement}
 */
function numberInput(field, value, onNumber) {
  const input = element("input", {
    type: "number",
    value: value === undefined || value === null ? "" : String(value),
    step: "any",
    placeholder: field.optional ? "–" : "",
    "aria-label": field.title,
  });
  const read = () => {
    const number = input.value === "" ? undefined : Number(input.value);
    const usable = usableNumber(field, number);
    input.toggleAttribute("aria-invalid", !usable);
    if (usable) onNumber(number);
  };
  input.addEventListener("input", read);
  input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault();
    const step = (field.step ?? 1) * (event.shiftKey ? 10 : 1) * (event.key === "ArrowUp" ? 1 : -1);
    const next = Math.min(Math.max((Number(input.value) || 0) + step, field.min ?? -Infinity), field.max ?? Infinity);
    input.value = String(Math.round(next * 1e6) / 1e6);
    read();
  });
  return input;
}

/**
 * @param {Pick<Field, "min" | "max" | "optional" | "kind">} field
 * @param {number | undefined} number
 */
function usableNumber(field, number) {
  if (number === undefined) return Boolean(field.optional);
  if (field.kind === "integer" && !Number.isInteger(number)) return false;
  return Number.isFinite(number) && number >= (field.min ?? -Infinity) && number <= (field.max ?? Infinity);
}

/**
 * A short table of pairs: factors along a path, angles by their times.
 *
 * @param {Field} field
 * @param {any} item
 * @param {Change} change
 * @returns {HTMLElement}
 */
function keysRow(field, item, change) {
  const rows = keysOf(field, item);
  const put = (/** @type {number[][]} */ changed, /** @type {string} */ key) => change(changesOf(field, changed), key);
  const columns = field.columns ?? ["", ""];
  const numbered = columns[0] === "key";
  const body = rows.map((row, index) => {
    const cells = row.map((value, column) =>
      numbered && column === 0
        ? element("span", { className: "physanimator-unit" }, [String(value + 1)])
        : numberInput({ title: `${field.title} ${index + 1}, ${columns[column]}`, kind: "number", step: 0.1 }, value, (number) => {
            if (number === undefined) return;
            const changed = rows.map((one) => [...one]);
            changed[index][column] = number;
            if (rising(changed, numbered ? 1 : 0)) put(changed, `${field.path}.${index}.${column}`);
          }),
    );
    const remove = () => put(rows.filter((_, i) => i !== index), "");
    const fewest = field.paths ? 2 : 0;
    const button = element("button", { type: "button", title: say("Remove this key"), "aria-label": say("Remove this key"), onclick: remove, disabled: rows.length <= fewest }, ["×"]);
    return element("div", { className: "physanimator-key" }, numbered ? cells : [...cells, button]);
  });
  const add = () => put([...rows, nextKey(rows, field)], "");
  const more = numbered ? [] : [element("button", { type: "button", title: say("Add a key"), onclick: add }, [say("+ key")])];
  const named = rows.length ? `${field.title}: ${columns.join(", ")}` : field.title;
  const note = element("span", { className: "physanimator-caption" }, [named]);
  return element("div", { className: "physanimator-field physanimator-table", title: field.hint, "data-field": field.path }, [
    element("div", { className: "physanimator-key physanimator-keyhead" }, [note, ...more]),
    ...body,
  ]);
}

/**
 * @param {Field} field
 * @param {any} item
 * @returns {number[][]}
 */
function keysOf(field, item) {
  if (field.paths) {
    const [first, second] = field.paths.map((path) => valueAt(item, path) ?? []);
    return first.map((/** @type {number} */ value, /** @type {number} */ i) => [value, second[i]]);
  }
  const values = valueAt(item, field.path) ?? [];
  return field.columns?.[0] === "key" ? values.map((/** @type {number} */ value, /** @type {number} */ i) => [i, value]) : values;
}

/**
 * @param {Field} field
 * @param {number[][]} rows
 * @returns {[string, any][]}
 */
function changesOf(field, rows) {
  if (field.paths) return field.paths.map((path, column) => [path, rows.map((row) => row[column])]);
  if (field.columns?.[0] === "key") return [[field.path, rows.map((row) => row[1])]];
  return [[field.path, rows.length ? rows : undefined]];
}

/**
 * @param {number[][]} rows
 * @param {number} column
 */
function rising(rows, column) {
  return rows.every((row, i) => row[column] >= 0 && (!i || row[column] > rows[i - 1][column]));
}

/**
 * @param {number[][]} rows
 * @param {Field} field
 */
function nextKey(rows, field) {
  const last = rows.at(-1);
  if (field.paths) return last ? [last[0] + 0.5, last[1]] : [0, 0];
  if (!last) return [0, 1];
  return last[0] < 1 ? [1, last[1]] : [last[0] + 0.1, last[1]];
}
