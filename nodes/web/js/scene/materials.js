/**
 * What bodies are made of: what the scene document says, and otherwise what they had when the node ran.
 *
 * @typedef {import("./document.js").Item} Item
 * @typedef {import("./document.js").SceneDocument} SceneDocument
 * @typedef {import("./fields.js").Field} Field
 * @typedef {import("./layers.js").Layer} Layer
 *
 * @typedef {object} Materials  as a run of the node tells them
 * @property {Record<string, Item>} presets  every value of each
 * @property {Item} plain  a material without a preset
 * @property {{name: string, material: Item}[]} bodies
 * @property {number[]} order  numbers of the bodies from back to front
 *
 * @typedef {object} Target  a body whose material can be edited
 * @property {string} label
 * @property {string} name  empty where it has none
 * @property {number} number  of the body in the run; -1 where it did not move then
 * @property {Item} material  that it had
 */

import { say, words } from "../host/words.js";
import { bodyOf, movesIn, withNames } from "./layers.js";

/** How a material can say how stiff it is. */
export const STIFFNESS = words("sway", "Young", "Lame");
const [SWAY, YOUNG, LAME] = STIFFNESS;

/** Digits to which numbers are converted. */
const DIGITS = 7;
/** Poisson's ratio is below a half, also where it is rounded. */
const HIGHEST_RATIO = 0.499999;

/**
 * The bodies, from front to back.
 *
 * @param {SceneDocument} document
 * @param {Materials | null} materials
 * @param {Layer[]} layers  none where the picture is flat
 * @returns {Target[]}
 */
export function targetsOf(document, materials, layers) {
  if (!materials) return [];
  const { bodies } = materials;
  if (!layers.length) {
    return [...materials.order].reverse().map((number) => ({ ...bodies[number], number, label: bodies[number].name || say("Body {number}", { number }) }));
  }
  return layers.filter((layer) => movesIn(document, layer)).map(({ name, preset }) => {
    const number = bodies.findIndex((body) => body.name === name);
    return { name, number, label: name, material: bodies[number]?.material ?? { preset } };
  });
}

/**
 * What is written of a body's material.
 *
 * @param {SceneDocument} document
 * @param {Target} target
 * @returns {Item}
 */
export function writtenOf(document, target) {
  return document.bodies?.[placeOf(document, target)]?.material ?? target.material;
}

/**
 * Every value of a material.
 *
 * @param {Item} written
 * @param {Materials} materials
 * @returns {Item}
 */
export function wholeOf(written, materials) {
  const whole = { ...materials.plain, ...materials.presets[written.preset], ...written };
  if (!known(whole.mu)) return whole;
  const [youngs_modulus, poisson_ratio] = youngOf(whole.mu, whole.lambda);
  return { ...whole, youngs_modulus, poisson_ratio, sway_frequency: null };
}

/** @param {Item} whole  how it says how stiff it is */
export function stiffnessOf(whole) {
  if (known(whole.mu)) return LAME;
  return known(whole.sway_frequency) ? SWAY : YOUNG;
}

/**
 * The document in which a body's material has other values.
 *
 * @param {SceneDocument} document
 * @param {Target} target
 * @param {[string, any][]} changes  values by their names; "preset" and "stiffness" change what goes with them
 * @param {Materials} materials
 * @param {Layer[]} layers
 * @param {number | null} [modulus]  Young's modulus that came of the sway
 * @returns {SceneDocument}
 */
export function withMaterial(document, target, changes, materials, layers, modulus = null) {
  const named = withNames(document, layers);
  const material = changes.reduce((made, [name, value]) => changed(made, name, value, materials, modulus), writtenOf(named, target));
  const bodies = [...(named.bodies ?? [])];
  const place = placeOf(named, target);
  while (bodies.length <= place) bodies.push({});
  bodies[place] = { ...bodies[place], material };
  return { ...named, bodies };
}

/**
 * @param {SceneDocument} document
 * @param {Target} target
 * @returns {number} of its entry, which need not be there yet
 */
function placeOf(document, target) {
  const named = target.name ? bodyOf(document, target.name) : -1;
  return named >= 0 ? named : Math.max(target.number, 0);
}

/**
 * @param {Item} written
 * @param {string} name
 * @param {any} value
 * @param {Materials} materials
 * @param {number | null} modulus
 * @returns {Item}
 */
function changed(written, name, value, materials, modulus) {
  if (name === "preset") return materials.presets[value] ? { preset: value } : wholeOf(written, materials);
  if (name === "stiffness") return told(written, value, materials, modulus);
  const { [name]: _, ...rest } = written;
  // Where a preset has a value, only null says that there is none.
  if (value === undefined) return known(materials.presets[written.preset]?.[name]) ? { ...rest, [name]: null } : rest;
  return { ...rest, [name]: value };
}

/**
 * The same material, which says in another way how stiff it is.
 *
 * @param {Item} written
 * @param {string} way
 * @param {Materials} materials
 * @param {number | null} modulus
 * @returns {Item}
 */
function told(written, way, materials, modulus) {
  const whole = wholeOf(written, materials);
  const { mu: _mu, lambda: _lambda, youngs_modulus: _young, poisson_ratio: _poisson, sway_frequency: _sway, ...rest } = written;
  const preset = materials.presets[written.preset];
  const young = stiffnessOf(whole) === SWAY ? (modulus ?? whole.youngs_modulus) : whole.youngs_modulus;
  const poisson = whole.poisson_ratio;
  if (way === LAME) {
    const [mu, lambda] = lameOf(young, poisson);
    return { ...rest, mu, lambda };
  }
  const constants = { youngs_modulus: rounded(young), poisson_ratio: rounded(poisson) };
  if (way === SWAY) return { ...rest, ...constants, sway_frequency: preset?.sway_frequency ?? 1 };
  return { ...rest, ...constants, ...(known(preset?.sway_frequency) ? { sway_frequency: null } : {}) };
}

/**
 * Lame parameters in plane strain: mu = E / (2 (1 + nu)), lambda = E nu / ((1 + nu) (1 - 2 nu)).
 *
 * @param {number} young
 * @param {number} poisson
 */
export function lameOf(young, poisson) {
  return [young / (2 * (1 + poisson)), (young * poisson) / ((1 + poisson) * (1 - 2 * poisson))].map(rounded);
}

/**
 * @param {number} mu
 * @param {number} lambda
 */
export function youngOf(mu, lambda) {
  const share = lambda / (lambda + mu);
  return [mu * (2 + share), Math.min(share / 2, HIGHEST_RATIO)].map(rounded);
}

/** @param {number} value */
function rounded(value) {
  return Number(value.toPrecision(DIGITS));
}

/** @param {any} value */
function known(value) {
  return value !== undefined && value !== null;
}

/**
 * @param {string} path
 * @param {string} title
 * @param {string} unit
 * @param {Partial<Field>} more
 * @returns {Field}
 */
function number(path, title, unit, more) {
  return { path, title, unit, kind: "number", hint: "", schema: `material.${path}`, ...more };
}

const STIFFEST = 1e12;
const MODULUS = "density side²/s²";
/** Shown instead, for want of room. */
const SHOWN = say("side²/s²");

/** @type {Record<string, Field[]>} */
const OF_STIFFNESS = {
  [SWAY]: [
    number("sway_frequency", say("Sway"), "Hz", { optional: true, min: 0.001, max: 1000, step: 0.1, hint: say("How often it sways about where it is held; the stiffness follows from it.") }),
    number("poisson_ratio", say("Poisson's ratio"), "", { default: 0.3, min: 0, max: 0.499, step: 0.01, hint: say("How much a stretched body narrows: 0 not at all, near 0.5 like rubber.") }),
  ],
  [YOUNG]: [
    number("youngs_modulus", say("Young's modulus"), MODULUS, { default: 500, min: 1e-6, max: STIFFEST, step: 10, hint: say("How hard it is to stretch and bend. Twice the sway needs four times as much.") }),
    number("poisson_ratio", say("Poisson's ratio"), "", { default: 0.3, min: 0, max: 0.499, step: 0.01, hint: say("How much a stretched body narrows: 0 not at all, near 0.5 like rubber.") }),
  ],
  [LAME]: [
    number("mu", say("mu"), MODULUS, { min: 1e-6, max: STIFFEST, step: 10, hint: say("Lame parameter: resistance to stretching, bending and shear, as in the paper.") }),
    number("lambda", say("lambda"), MODULUS, { min: 0, max: STIFFEST, step: 10, hint: say("Lame parameter: resistance to a change of area, as in the paper; 0 for none.") }),
  ],
};

/** @type {Field[]} */
const OTHERS = [
  number("density", say("Density"), "", { default: 1, min: 1e-6, max: 1e6, step: 0.1, hint: say("Mass for its size; 1 is ordinary.") }),
  number("damping", say("Damping"), "1/s", { default: 1.5, min: 0, max: 1e6, step: 0.1, hint: say("How fast motion dies away: 0 never, 1 within some seconds, 5 almost at once.") }),
  number("stretch_limit", say("Stretch limit"), "×", { optional: true, min: 1, max: 1e6, step: 0.01, hint: say("How many times as far as drawn a point gets from where it is held. Empty: no limit.") }),
  number("wind_response", say("Wind response"), "×", { default: 1, min: 0, max: 1e6, step: 0.1, hint: say("How strongly wind and strokes act on it.") }),
  number("root_stiffness", say("Root stiffness"), "×", { default: 1, min: 1, max: 1000, step: 1, hint: say("How many times as stiff it is where it is held as at its tip.") }),
];

/**
 * @param {number} modulus
 * @returns {number} a step of some hundredths of it: materials lie many powers of ten apart
 */
function stepOf(modulus) {
  return 10 ** (Math.floor(Math.log10(modulus)) - 1);
}

/** Every field of a material, for the tests. */
export const MATERIAL_FIELDS = [...Object.values(OF_STIFFNESS).flat(), ...OTHERS];

/**
 * @param {Materials} materials
 * @param {Item} written
 * @returns {Field[]}
 */
export function materialFields(materials, written) {
  const own = written.preset ? [] : words("own");
  const whole = wholeOf(written, materials);
  const way = stiffnessOf(whole);
  return [
    { path: "preset", title: say("Preset"), kind: "choice", default: "own", choices: [...own, ...Object.keys(materials.presets)], hint: say("What it is made of, with its usual values.") },
    { path: "stiffness", title: say("Stiffness by"), kind: "choice", default: way, choices: STIFFNESS, hint: say("How often it sways, Young's modulus and Poisson's ratio, or the Lame parameters mu and lambda.") },
    ...OF_STIFFNESS[way].map((field) => (field.unit === MODULUS ? { ...field, unit: SHOWN, step: stepOf(whole[field.path] || whole.mu) } : field)),
    ...OTHERS,
  ];
}
