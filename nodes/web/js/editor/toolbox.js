/**
 * Every tool by its id.
 *
 * @typedef {import("../stage/tool.js").Desk} Desk
 * @typedef {import("../stage/tool.js").Tool} Tool
 */

import { PolygonTool, RegionBrushTool, StiffnessTool } from "../stage/area_tools.js";
import { CircleTool, LeadTool, PinTool, QueryTool, StrokeTool, WaveTool } from "../stage/drawing_tools.js";
import { EraseTool, SelectTool } from "../stage/selecting_tools.js";

/** @type {Record<string, new (desk: Desk, id: string) => Tool>} */
const KINDS = {
  select: SelectTool,
  "query-positive": QueryTool,
  "query-negative": QueryTool,
  wind: StrokeTool,
  repel: StrokeTool,
  attract: StrokeTool,
  pin: PinTool,
  path: LeadTool,
  wave: WaveTool,
  "region-circle": CircleTool,
  "region-polygon": PolygonTool,
  "region-brush": RegionBrushTool,
  stiffness: StiffnessTool,
  erase: EraseTool,
};

export const BRUSHES = ["region-brush", "stiffness", "erase"];

/**
 * @param {Desk} desk
 * @param {string[]} ids
 * @returns {Map<string, Tool>}
 */
export function toolsOf(desk, ids) {
  return new Map(ids.filter((id) => id in KINDS).map((id) => [id, new KINDS[id](desk, id)]));
}
