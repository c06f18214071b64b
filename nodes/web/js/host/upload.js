/**
 * A button that uploads a layered file, or the pictures of one, into the host's input folder, and dropping them.
 *
 * The host's own button takes single pictures of some types alone; its server takes any file.
 *
 * @typedef {any} GraphNode  of LiteGraph
 */

import { say } from "./words.js";

const ACCEPTED = ".psd,.psb,.ora,.png,.json";
const LAYERED = /\.(psd|psb|ora)$/i;
const OF_A_FOLDER = /\.(png|json)$/i;

/**
 * What of some files is uploaded: one layered file, or pictures that make one in a folder of their own.
 *
 * @template {{name: string}} T
 * @param {T[]} files
 * @param {string} folder  a name that no folder has
 * @returns {{files: T[], subfolder: string} | null} null where there is nothing to load
 */
export function uploadOf(files, folder) {
  const layered = files.find((file) => LAYERED.test(file.name));
  if (layered) return { files: [layered], subfolder: "" };
  const pictures = files.filter((file) => OF_A_FOLDER.test(file.name));
  return pictures.length > 1 ? { files: pictures, subfolder: folder } : null;
}

/**
 * @param {any} app the host's application
 * @param {any} api the host's connection to its server
 * @param {GraphNode} node
 * @param {string} name  of the widget that holds the file
 */
export function attachUpload(app, api, node, name) {
  const picker = Object.assign(document.createElement("input"), { type: "file", accept: ACCEPTED, multiple: true });
  const take = async (/** @type {File[]} */ files) => {
    const chosen = uploadOf(files, `layers_${Date.now().toString(36)}`);
    if (!chosen) return warn(app, say("Choose a .psd, .psb or .ora file, or several PNG files of one size."));
    try {
      let stored = "";
      for (const file of chosen.files) stored = await upload(api, file, chosen.subfolder);
      choose(app, node, name, chosen.subfolder || stored);
    } catch (error) {
      warn(app, say("The file could not be uploaded: {reason}", { reason: reasonOf(error) }));
    }
  };
  picker.addEventListener("change", () => {
    take([...(picker.files ?? [])]);
    picker.value = "";
  });
  const button = node.addWidget("button", "upload", "upload", () => picker.click(), { serialize: false });
  button.label = say("choose a layered file to upload");
  button.tooltip = say("A .psd, .psb or .ora file, or all PNG files of a folder together.");
  button.serialize = false;
  node.onDragOver = (/** @type {DragEvent} */ event) => !!event.dataTransfer?.types?.includes("Files");
  node.onDragDrop = (/** @type {DragEvent} */ event) => {
    const files = [...(event.dataTransfer?.files ?? [])];
    if (!uploadOf(files, "any")) return false;
    take(files);
    return true;
  };
}

/**
 * @param {unknown} error
 * @returns {string}
 */
function reasonOf(error) {
  if (error instanceof TypeError) return say("the server does not answer");
  return error instanceof Error ? error.message : String(error);
}

/**
 * @param {any} api
 * @param {File} file
 * @param {string} subfolder
 * @returns {Promise<string>} its path in the input folder
 */
export async function upload(api, file, subfolder) {
  const body = new FormData();
  body.append("image", file);
  if (subfolder) body.append("subfolder", subfolder);
  const answer = await api.fetchApi("/upload/image", { method: "POST", body });
  if (answer.status === 413) throw new Error(say("it is larger than the server takes (--max-upload-size)"));
  if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
  const stored = await answer.json();
  return stored.subfolder ? `${stored.subfolder}/${stored.name}` : stored.name;
}

/**
 * @param {any} app
 * @param {GraphNode} node
 * @param {string} name
 * @param {string} value
 */
export function choose(app, node, name, value) {
  const widget = node.widgets.find((/** @type {any} */ one) => one.name === name);
  const values = widget.options?.values;
  if (Array.isArray(values) && !values.includes(value)) values.push(value);
  widget.value = value;
  widget.callback?.(value);
  app.graph?.setDirtyCanvas?.(true, true);
}

/**
 * @param {any} app
 * @param {string} sentence
 * @param {string} [title]
 */
export function warn(app, sentence, title = say("Load Layers")) {
  app.extensionManager?.toast?.add({ severity: "warn", summary: title, detail: sentence, life: 10_000 });
}
