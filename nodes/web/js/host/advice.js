/** What a node wants to say to the person at the browser, as the host's toast; see nodes/host/messages.py. */

const EVENT = "physanimator.advice";
const LIFE = 30_000; // [ms]

/**
 * @param {any} app the host's application
 * @param {any} api the host's connection to its server
 */
export function showAdvice(app, api) {
  api.addEventListener(EVENT, (/** @type {any} */ event) => {
    const { title, sentences } = event.detail;
    for (const sentence of sentences) {
      app.extensionManager?.toast?.add({ severity: "warn", summary: title, detail: sentence, life: LIFE });
    }
  });
}
