/**
 * What the page says, in the language that the host is set to. The English text is the key of its translation, as in
 * gettext; the translations are in nodes/web/words.
 */

/** Languages that there is a file for, by what Comfy.Locale says. */
const LANGUAGES = ["ja", "ko", "zh", "zh-TW"];
const SETTING = "Comfy.Locale";

/** @type {Record<string, string>} */
const translations = {};

// Everything that says something waits for this, also where it does so while its module is read.
if (globalThis.document) Object.assign(translations, await translationsOf(await language()));

/**
 * @param {string} text  in English; `{name}` stands for a value
 * @param {Record<string, unknown>} [values]
 * @returns {string} in the user's language, or in English where there is no translation
 */
export function say(text, values = {}) {
  return filled(translations[text] ?? text, values);
}

/** @returns {boolean} whether it says something else than English */
export function translates() {
  return Object.keys(translations).length > 0;
}

/**
 * Marks texts that are handed to `say` later, because what is written into a scene stays English.
 *
 * @param {string[]} texts
 */
export function words(...texts) {
  return texts;
}

/**
 * @param {string} text
 * @param {Record<string, unknown>} values
 */
export function filled(text, values) {
  return text.replace(/\{(\w+)\}/g, (whole, name) => (Object.hasOwn(values, name) ? String(values[name]) : whole));
}

/**
 * Where the user has chosen no language, the host takes that of the browser.
 *
 * @returns {Promise<string>}
 */
async function language() {
  try {
    const { api } = await import(new URL("../../../../scripts/api.js", import.meta.url).href);
    return (await api.getSetting(SETTING)) || navigator.language;
  } catch {
    return navigator.language;
  }
}

/**
 * @param {string} chosen
 * @returns {Promise<Record<string, string>>}
 */
async function translationsOf(chosen) {
  const name = LANGUAGES.find((one) => one === chosen) ?? LANGUAGES.find((one) => one === chosen.split("-")[0]);
  if (!name) return {};
  try {
    const answer = await fetch(new URL(`../../words/${name}.json`, import.meta.url), { cache: "no-cache" });
    return answer.ok ? await answer.json() : {};
  } catch {
    return {};
  }
}
