/** What a node wants to say to the person at the browser, as the host's toast; see nodes/host/messages.py. */

const EVENT = "physanimator.advice";
const LIFE = 30_000; // [ms]
/** Toasts of older and newer frontends. */
const TOAST = ".p-toast-message, [data-toast-kind]";

/**
 * @param {any} app the host's application
 * @param {any} api the host's connection to its server
 */
export function showAdvice(app, api) {
  api.addEventListener(EVENT, (/** @type {any} */ event) => {
    const { title, sentences } = event.detail;
    for (const sentence of sentences) {
      if (isShown(title, sentence)) continue;
      app.extensionManager?.toast?.add({ severity: "warn", summary: title, detail: sentence, life: LIFE });
    }
  });
}

/**
 * @param {string} title
 * @param {string} sentence
 * @returns {boolean} whether a toast on the page says so still: ten runs need not say it ten times over
 */
function isShown(title, sentence) {
  return [...document.querySelectorAll(TOAST)].some(({ textContent }) => textContent?.includes(title) && textContent.includes(sentence));
}
