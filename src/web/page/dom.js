// Elements of the page. Texts become text nodes only: a name can have any letters.

/** An element with attributes, properties (`.name`), listeners (functions) and children. */
export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (name.startsWith(".")) element[name.slice(1)] = value;
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** An element of a drawing. */
export function svg(tag, attributes = {}, text = null) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== null) element.textContent = text;
  return element;
}

/** Sets a text if it is another one, so that a screen reader is not told again. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Sets an attribute if it is another one. */
export function set(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

export function body(id) {
  return document.querySelector(`#${id} .body`);
}

/** A time in seconds as the machine counts it. */
export function seconds(time) {
  return `${time.toFixed(3)} s`;
}

export function button(label, press, attributes = {}) {
  return el("button", { type: "button", click: press, ...attributes }, label);
}

/** A field with its label. */
export function field(label, control) {
  return el("label", { class: "field" }, el("span", {}, label), control);
}
