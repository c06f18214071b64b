/**
 * Makes an element with properties, attributes and children.
 *
 * @param {string} tag
 * @param {Record<string, any>} [properties]  "data-..." and "aria-..." become attributes, "on..." listeners
 * @param {(Node | string)[]} [children]
 * @returns {any}
 */
export function element(tag, properties = {}, children = []) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (name.includes("-")) made.setAttribute(name, String(value));
    else Reflect.set(made, name, value);
  }
  made.append(...children);
  return made;
}

/**
 * @param {HTMLElement} root  of an editor
 * @returns {boolean} whether somebody works with it: it has the focus, or fills the window
 */
export function isUsed(root) {
  return root.contains(document.activeElement) || root.querySelector("dialog[open]") !== null;
}
