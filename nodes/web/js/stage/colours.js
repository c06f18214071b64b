/** Colours of what is drawn on the picture; every line has a dark edge, so that they show on light and dark pictures. */
export const COLOURS = /** @type {Record<string, string>} */ ({
  wind: "#4db5ff",
  repel: "#ff8a3d",
  attract: "#c48bff",
  pin: "#ff5c8a",
  path: "#3ddc97",
  wave: "#3ddc97",
  paint: "#ffd43b",
  colliders: "#b8c0cc",
  positive: "#40d67b",
  negative: "#ff5252",
  edge: "rgba(10, 12, 16, 0.75)",
});

/** Of the parts that are picked, one after the other. */
const PARTS = [COLOURS.positive, "#4db5ff", "#ffb02e", "#c48bff", "#ff5c8a", "#2dd4cf", "#d6e04a", "#ff8a3d"];

/** @param {number} part  its number, from 0; negative for what moves without being picked */
export function partColour(part) {
  return part < 0 ? COLOURS.colliders : PARTS[part % PARTS.length];
}

/**
 * @param {string} list
 * @param {Record<string, any>} item
 */
export function colourOf(list, item) {
  if (list === "strokes") return COLOURS[item.kind ?? "wind"];
  if (list === "query_points") return item.positive === false ? COLOURS.negative : partColour(item.part ?? 0);
  if (list === "rig_points") return (item.motion?.type ?? "pinned") === "pinned" ? COLOURS.pin : COLOURS.path;
  return COLOURS[list];
}
