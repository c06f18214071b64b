/** What the page's performance timeline is told, so that it can be measured how soon something moves. */

export const PEN_UP = "physanimator-pen-up";
export const MOVES = "physanimator-moves";

/**
 * The last moment of its name takes the place of those before.
 *
 * @param {string} name
 * @param {number} [at]  [ms] of the page's clock
 */
export function mark(name, at = performance.now()) {
  performance.clearMarks(name);
  performance.mark(name, { startTime: at });
}
