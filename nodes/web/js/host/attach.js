/**
 * Puts an editor into a node of the host. It works in the LiteGraph canvas and in the Vue canvas.
 *
 * @typedef {object} Kind  of node
 * @property {string} input  name of the text input that holds the value
 * @property {any} format
 * @property {string[][]} groups
 * @property {boolean} moves
 * @property {[number, number]} size  of a new node, at least
 * @property {string} [empty]  what to do while there are no points
 * @property {string} [title]  of the large view
 * @property {(app: any, api: any, node: any) => import("../editor/picking.js").PickOptions} [picks]  where parts are picked
 * @property {(node: any, rootGraph: any, outputs?: any) => string | null} [picture]  path of the picture, where it is not that upstream
 * @property {boolean} [result]  whether what the node shows of a run is shown here
 */

import { Editor } from "../editor/editor.js";
import { shareGestures } from "./gestures.js";
import { bringIntoView } from "./into_view.js";
import { executionId, runNode } from "./queueing.js";
import { upstreamPicture } from "./upstream.js";
import { chain, embed, hide, tell } from "./widgets.js";

/** Heights in which a narrow editor has all in sight, without and with parts to pick and a bar to play them [px]. */
const SHORTEST = 300;
const SHORTEST_PICKING = 400;
/** After this time a new node is on the canvas [ms]. */
const SETTLED = 150;
/** Time from one look at the graph to the next [ms]. */
const LOOKS = 500;
const OUTPUT = "physanimator_editor";
/** What the host tells of a run that is over. */
const ENDS = ["execution_error", "execution_interrupted", "execution_success"];
/** What a node sends that refuses to go on because no layer moves; see nodes/layer_lists.py. */
export const LAYERS = "physanimator.layers";
/** What a node sends of a picture that other nodes have made; see nodes/animate_nodes.py. */
const PICTURE = "physanimator.picture";

/**
 * @param {any} app  the host's
 * @param {any} api  the host's
 * @param {any} node
 * @param {Kind} kind
 */
export function attachEditor(app, api, node, kind) {
  const value = node.widgets?.find((/** @type {any} */ widget) => widget.name === kind.input);
  if (!value) return null;
  const editor = new Editor({
    ...kind,
    picks: kind.picks?.(app, api, node) ?? null,
    fetch: (path, options) => api.fetchApi(path, options),
    onChange: (text) => (value.value = text),
    onKept: () => tell(app, node, value),
    onRun: () => {
      editor.backdrop.wait();
      runNode(app, node).then((queued) => queued === false && editor.backdrop.stopWaiting(), () => editor.backdrop.stopWaiting());
    },
  });
  hide(value);
  embed(node, "physanimator_editor", editor.root, kind.picks && kind.moves ? SHORTEST_PICKING : SHORTEST);
  shareGestures(app, node, editor.root);
  follow(app, api, node, value, editor, kind);
  grow(app, node, kind.size, editor.root);
  return editor;
}

/**
 * Give a new node its size, and bring it into view; one that is opened with its workflow keeps what the user made of it.
 *
 * @param {any} app
 * @param {any} node
 * @param {[number, number]} size
 * @param {HTMLElement} root
 */
function grow(app, node, size, root) {
  let opened = false;
  chain(node, "onConfigure", () => (opened = true));
  node.setSize?.([Math.max(node.size[0], size[0]), Math.max(node.size[1], size[1])]);
  chain(node, "onAdded", () => bringIntoView(app, node, () => opened));
  // Older Vue canvases measure a new node once by themselves, and then only listen to the size of its box.
  chain(node, "onAdded", () =>
    setTimeout(() => {
      const box = /** @type {HTMLElement | null} */ (root.closest("[data-node-id]"));
      if (opened || !box || box.offsetWidth >= size[0] - 1) return;
      box.style.setProperty("--node-width", `${size[0]}px`);
      box.style.setProperty("--node-height", `${size[1]}px`);
    }, SETTLED),
  );
}

/**
 * Keep the editor up to date with the graph.
 *
 * @param {any} app
 * @param {any} api
 * @param {any} node
 * @param {any} value
 * @param {Editor} editor
 * @param {Kind} kind
 */
function follow(app, api, node, value, editor, kind) {
  let picture = /** @type {string | null | undefined} */ (undefined);
  const look = () => {
    if (!node.graph) return;
    takePlace(node, editor.root);
    editor.load(String(value.value ?? ""));
    const found = (kind.picture ?? upstreamPicture)(node, app.rootGraph ?? app.graph, app.nodeOutputs);
    editor.picking?.changed();
    if (found === picture) return;
    const first = picture === undefined;
    picture = found;
    if (!first) editor.backdrop.forgetRun();
    if (found) editor.backdrop.setPicture(api.apiURL(found)).then(() => editor.picking?.changed());
    else if (editor.picking) editor.backdrop.forgetPicture();
  };
  editor.look = look;
  // The editor shows what the node shows: in the Vue canvas the host has a word for that, in the other it draws here.
  if (kind.result) Object.assign(node, { hideOutputImages: true, onDrawBackground: () => {} });
  const ran = (/** @type {any} */ output) => {
    const [info] = output?.[OUTPUT] ?? [];
    editor.advise(output?.advice ?? []);
    const [shown] = (kind.result && output?.images) || [];
    const [seen] = output?.physanimator_picture ?? [];
    if (seen) node.physanimatorSeen = pathOf(seen);
    if (shown) editor.picking?.takeResult(api.apiURL(pathOf(shown)), /\.mp4$/.test(shown.filename));
    if (info) editor.backdrop.setRun(runOf(api, info)).catch((error) => editor.backdrop.trouble(error));
  };
  chain(node, "onConfigure", () => queueMicrotask(look));
  chain(node, "onConnectionsChange", () => queueMicrotask(look));
  chain(node, "onExecuted", ran);
  // The graph does not tell when a node upstream changes.
  editor.root.addEventListener("pointerenter", look);
  /** @type {any} */
  let remains = 0;
  chain(node, "onAdded", () => {
    clearInterval(remains);
    remains = setInterval(look, LOOKS);
    setTimeout(look, SETTLED);
  });
  const refused = (/** @type {any} */ { detail }) => {
    if (node.graph && detail.node === executionId(node, app.rootGraph ?? app.graph)) editor.refuseLayers(detail.layers);
  };
  const pictured = (/** @type {any} */ { detail: { node: id, ...saved } }) => {
    if (!node.graph || !kind.picture || id !== executionId(node, app.rootGraph ?? app.graph)) return;
    node.physanimatorSeen = pathOf(saved);
    look();
  };
  api.addEventListener(LAYERS, refused);
  api.addEventListener(PICTURE, pictured);
  const reconnected = () => editor.backdrop.reconnected();
  api.addEventListener("reconnected", reconnected);
  const ended = () => editor.backdrop.stopWaiting();
  for (const name of ENDS) api.addEventListener(name, ended);
  chain(node, "onRemoved", () => {
    clearInterval(remains);
    for (const name of ENDS) api.removeEventListener(name, ended);
    api.removeEventListener(LAYERS, refused);
    api.removeEventListener(PICTURE, pictured);
    api.removeEventListener("reconnected", reconnected);
    editor.release();
  });
  queueMicrotask(() => {
    look();
    editor.load(String(value.value ?? ""));
    ran(app.nodeOutputs?.[String(node.id)]);
  });
}

/**
 * An older Vue canvas keeps showing what belonged to the node that had this id before, such as before undoing.
 *
 * @param {any} node
 * @param {HTMLElement} root
 */
function takePlace(node, root) {
  if (root.isConnected) return;
  const left = document.querySelector(`[data-node-id="${CSS.escape(String(node.id))}"] .physanimator-editor[data-released]`);
  left?.replaceWith(root);
}

/** @param {any} saved  as the host tells where a file is */
function pathOf(saved) {
  return `/view?${new URLSearchParams(saved)}`;
}

/**
 * @param {any} api
 * @param {any} info  as the node tells it
 * @returns {import("../editor/live.js").Run}
 */
function runOf(api, { key, width, height, image, plate, layers = null, materials = null, holds = [] }) {
  const url = (/** @type {any} */ saved) => api.apiURL(`/view?${new URLSearchParams(saved)}`);
  const behind = plate ? url(plate) : api.apiURL(`/physanimator/plate/${key}`);
  const drawn = (layers?.drawn ?? []).map((/** @type {any} */ one, /** @type {number} */ number) => ({ ...one, url: api.apiURL(`/physanimator/layer/${key}/${number}`) }));
  return { key, width, height, image: image ? url(image) : null, plate: behind, layers: layers && { layers: layers.layers, drawn }, materials, holds };
}
