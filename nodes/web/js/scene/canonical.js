/**
 * One spelling for a value, so that the same scene is known again whatever the order of its keys.
 *
 * @param {any} value  of JSON
 * @returns {string}
 */
export function canonical(value) {
  return JSON.stringify(value, (_, one) => {
    if (!one || typeof one !== "object" || Array.isArray(one)) return one;
    return Object.fromEntries(Object.entries(one).sort(([a], [b]) => (a < b ? -1 : 1)));
  });
}
