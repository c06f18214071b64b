/** Icons of the toolbar, drawn on a grid of 20 x 20 in the colour of the text. */

const LINE = 'fill="none" stroke="currentColor" stroke-width="1.6" stroke-linecap="round" stroke-linejoin="round"';

/** @type {Record<string, string>} the inside of each icon */
const SHAPES = {
  select: '<path d="M5 3l10 7-4.6.8L13 16l-2 1-2.5-5.100L5 15z"/>',
  "query-positive": '<circle cx="10" cy="10" r="6.5"/><path d="M10 7v6M7 10h6"/>',
  "query-negative": '<circle cx="10" cy="10" r="6.5"/><path d="M7 10h6"/>',
  wind: '<path d="M3 7h8.500a2.3 2.3 0 1 0-2.2-3M3 10.500h12a2.3 2.3 0 1 1-2.2 3M3 14h6.500a2 2 0 1 1-1.9 2.6"/>',
  repel: '<circle cx="10" cy="10" r="1.5" fill="currentColor"/><path d="M10 6V2m-1.8 1.800L10 2l1.8 1.800M10 14v4m-1.8-1.800L10 18l1.8-1.800M6 10H2m1.8-1.800L2 10l1.8 1.800M14 10h4m-1.8-1.800L18 10l-1.8 1.8"/>',
  attract: '<circle cx="10" cy="10" r="1.5" fill="currentColor"/><path d="M10 2v4.500M8.2 4.700L10 6.500l1.8-1.800M10 18v-4.500m-1.8 1.800L10 13.500l1.8 1.800M2 10h4.500M4.7 8.200L6.5 10l-1.8 1.800M18 10h-4.500m1.8-1.800L13.5 10l1.8 1.8"/>',
  pin: '<path d="M7 3h6M8 3v5l-2.5 3.500h9L12 8V3M10 11.500V18"/>',
  hold: '<path d="M3 12a7 7 0 1 1 2 5M3 17v-5h5M8 6h4M8.7 6v3l-1.2 2.200h5L11.3 9V6M10 11.200V15"/>',
  path: '<circle cx="4.5" cy="15" r="1.8"/><path d="M6.3 14.500c5-.5 1-8 6-8.500H16m-2.5-2.500L16 6l-2.5 2.5"/>',
  wave: '<path d="M2 10h16M4.5 7.500L2 10l2.5 2.500M15.5 7.500L18 10l-2.5 2.5"/><circle cx="10" cy="10" r="2.2" fill="currentColor"/>',
  "region-circle": '<circle cx="10" cy="10" r="7" stroke-dasharray="2.8 2.2"/><circle cx="10" cy="10" r="1" fill="currentColor"/>',
  "region-polygon": '<path d="M4 15L3 6l8-3 6 6-3 8z" stroke-dasharray="3 2.2"/>',
  "region-brush": '<path d="M16.5 3.500c-3 1-6.5 4.5-8 7l1.5 1.500c2.5-1.5 6-5 7-8zM8 11c-2 0-3 1-3 3 0 1-.8 2-2 2.3 2.5 1.2 6.5.5 6.8-3.3"/>',
  stiffness: '<path d="M3 4v12M17 4v12M3 10h2l1-3 2 6 2-6 2 6 2-6 1 3h2"/>',
  erase: '<path d="M8.5 16.500l-5-5 7.5-7.5 5.5 5.5-7 7zM7 8l5.5 5.500M8 16.500h9"/>',
  undo: '<path d="M7 4L3.5 7.5 7 11M4 7.500h8a4.5 4.5 0 0 1 0 9H8"/>',
  redo: '<path d="M13 4l3.5 3.500L13 11M16 7.500H8a4.5 4.5 0 0 0 0 9h4"/>',
  duplicate: '<rect x="3" y="3" width="10" height="10" rx="1.5"/><path d="M15.5 7H16a1 1 0 0 1 1 1v8a1 1 0 0 1-1 1H8a1 1 0 0 1-1-1v-.5"/>',
  delete: '<path d="M3.5 5.500h13M8 5V3h4v2M5.5 5.500l.8 11.500h7.400l.8-11.500M8.5 8.500v5.500M11.5 8.500v5.5"/>',
  fit: '<path d="M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4"/><rect x="6.5" y="7.5" width="7" height="5"/>',
  "zoom-in": '<circle cx="9" cy="9" r="5.5"/><path d="M13 13l4 4M9 6.500v5M6.5 9h5"/>',
  "zoom-out": '<circle cx="9" cy="9" r="5.5"/><path d="M13 13l4 4M6.5 9h5"/>',
  mesh: '<path d="M3 16L10 3l7 13zM6.5 9.500h7M6.5 9.500L10 16l3.5-6.5"/>',
  items: '<path d="M2 10c2-3.5 5-5 8-5s6 1.5 8 5c-2 3.5-5 5-8 5s-6-1.5-8-5z"/><circle cx="10" cy="10" r="2.3"/>',
  expand: '<path d="M12 3h5v5M17 3l-6 6M8 17H3v-5M3 17l6-6"/>',
  shrink: '<path d="M11 4v5h5M11 9l6-6M9 16v-5H4M9 11l-6 6"/>',
  play: '<path d="M6 4l10 6-10 6z" fill="currentColor"/>',
  pause: '<path d="M7 4v12M13 4v12" stroke-width="2.6"/>',
  loop: '<path d="M4 9a5 5 0 0 1 5-4h6m-2.5-2.500L15 5l-2.5 2.500M16 11a5 5 0 0 1-5 4H5m2.5 2.500L5 15l2.5-2.5"/>',
  panel: '<rect x="3" y="4" width="14" height="12" rx="1.5"/><path d="M12 4v12"/>',
};

/**
 * @param {string} name
 * @returns {string} of an SVG element
 */
export function icon(name) {
  return `<svg viewBox="0 0 20 20" width="18" height="18" aria-hidden="true" focusable="false" ${LINE}>${SHAPES[name] ?? ""}</svg>`;
}
