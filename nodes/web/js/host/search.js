/**
 * Search words of nodes on pages that look at names alone, such as that of frontend 1.35.9. Newer ones look at the words by
 * themselves, so what is relied on here belongs to frontends that change no more.
 *
 * @typedef {{name: string, display_name?: string, search_aliases?: string[]}} Definition  of a node
 * @typedef {{filterDef: {matches: (node: Definition, value: any) => boolean}, value: any}} Filter
 */

const SHORTEST = 2;

/** @param {any} app */
export function searchByWords(app) {
  // The page's stores know each other.
  const service = app.extensionManager?._p?._s?.get("nodeDef")?.nodeSearchService;
  const keys = service?.nodeFuseSearch?.keys;
  if (!Array.isArray(keys) || !keys.includes("display_name") || keys.includes("search_aliases")) return;
  const kind = Object.getPrototypeOf(service);
  const before = kind.searchNode;
  kind.searchNode = function (/** @type {string} */ query, /** @type {Filter[]} */ filters = [], /** @type {any} */ options, /** @type {any[]} */ ...rest) {
    const found = before.call(this, query, filters, { ...options, limit: undefined }, ...rest);
    const all = this.nodeFuseSearch.data.filter((/** @type {Definition} */ node) => filters.every(({ filterDef, value }) => filterDef.matches(node, value)));
    return withWords(found, all, query).slice(0, options?.limit ?? Infinity);
  };
}

/**
 * Results of a search in names with those that the words give: after the names that hold what is sought, before those that
 * are only like it.
 *
 * @template {Definition} T
 * @param {T[]} found  by name
 * @param {T[]} all  that could be found
 * @param {string} query
 * @returns {T[]}
 */
export function withWords(found, all, query) {
  const sought = query.trim().toLowerCase();
  if (sought.length < SHORTEST) return found;
  const named = found.filter((node) => `${node.name} ${node.display_name ?? ""}`.toLowerCase().includes(sought));
  const ranked = all.map((node) => ({ node, rank: rankOf(node.search_aliases ?? [], sought) })).filter(({ rank }) => rank < Infinity);
  ranked.sort((one, other) => one.rank - other.rank);
  return [...new Set([...named, ...ranked.map(({ node }) => node), ...found])];
}

/**
 * @param {string[]} words
 * @param {string} sought
 */
function rankOf(words, sought) {
  const lower = words.map((word) => word.toLowerCase());
  if (lower.includes(sought)) return 0;
  if (lower.some((word) => word.startsWith(sought))) return 1;
  return lower.some((word) => word.includes(sought)) ? 2 : Infinity;
}
