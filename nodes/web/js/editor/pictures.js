/** Pictures for the background: from the graph, from a run, pasted or dropped. */

import { say } from "../host/words.js";

/**
 * @param {string} url
 * @returns {Promise<HTMLImageElement>}
 */
export function loaded(url) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error(say("The picture cannot be shown.")));
    image.src = url;
  });
}

/**
 * The first picture among what is pasted or dropped.
 *
 * @param {DataTransfer | null} data
 * @returns {File | null}
 */
export function pictureIn(data) {
  return [...(data?.files ?? [])].find((file) => file.type.startsWith("image/")) ?? null;
}

/** @param {DataTransfer | null} data whether something that may be a picture is dragged */
export function mayHoldPicture(data) {
  return [...(data?.items ?? [])].some((item) => item.kind === "file" && (!item.type || item.type.startsWith("image/")));
}
