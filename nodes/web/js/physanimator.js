/** The one module that registers something with the host; all others are imported from here and do nothing by themselves. */

import { app } from "../../../scripts/app.js";
import { api } from "../../../scripts/api.js";
import { showAdvice } from "./host/advice.js";
import { attachEditor } from "./host/attach.js";
import { animatedPicture, picksOfAnimation, picksOfSegmentation, segmentedPicture } from "./host/attach_picks.js";
import { attachLayers } from "./host/attach_layers.js";
import { POINTS, SCENE } from "./host/formats.js";
import { translateWidgets } from "./host/labels.js";
import { searchByWords } from "./host/search.js";
import { presentTemplates } from "./host/templates.js";
import { attachUpload } from "./host/upload.js";
import { say } from "./host/words.js";
import { PICK_GROUPS, POINT_GROUPS, SCENE_GROUPS } from "./panels/toolbar.js";

/** @type {Record<string, import("./host/attach.js").Kind>} */
const KINDS = {
  PhysAnimator_SceneEditor: { title: say("Scene Editor"), input: "scene", format: SCENE, groups: SCENE_GROUPS, moves: true, size: [810, 580] },
  PhysAnimator_SegmentByPoints: { title: say("Segment by Points"), input: "points", format: POINTS, groups: POINT_GROUPS, moves: false, size: [400, 440], picks: picksOfSegmentation, picture: segmentedPicture },
  PhysAnimator_AnimateIllustration: { title: say("Animate Illustration"), input: "points", format: POINTS, groups: PICK_GROUPS, moves: true, size: [640, 800], picks: picksOfAnimation, picture: animatedPicture, result: true },
};

presentTemplates(api);

app.registerExtension({
  name: "PhysAnimator.Editor",
  setup() {
    showAdvice(app, api);
    searchByWords(app);
  },
  /**
   * @param {any} nodeType
   * @param {any} nodeData
   */
  beforeRegisterNodeDef(nodeType, nodeData) {
    if (nodeData.name.startsWith("PhysAnimator_")) translateWidgets(nodeType);
    const kind = KINDS[nodeData.name];
    const uploads = nodeData.name === "PhysAnimator_LoadLayers";
    const lists = nodeData.name === "PhysAnimator_ArtworkToBodies";
    if (!kind && !uploads && !lists) return;
    const before = nodeType.prototype.onNodeCreated;
    // Earlier than the hook for created nodes, which comes when the Vue canvas has taken the node's size already.
    nodeType.prototype.onNodeCreated = function () {
      before?.apply(this, arguments);
      if (uploads) attachUpload(app, api, this, "file");
      else if (lists) this.physanimatorLayers = attachLayers(app, api, this, "scene");
      else this.physanimatorEditor = attachEditor(app, api, this, kind);
    };
  },
});
