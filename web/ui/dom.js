// Building elements: texts are set as text, styles through the CSSOM.

const SVG = "http://www.w3.org/2000/svg";

/** An element with properties (and `class`, `aria-*`, `data-*` attributes) and children, nodes or strings. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "class") made.className = value;
    else if (/^(aria|data)-|^role$/.test(name)) made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

/**
 * An element of index.html, by its id.
 * @returns {any}
 */
export const byId = (id) => document.getElementById(id);

/**
 * The 2D context of a canvas.
 * @returns {CanvasRenderingContext2D}
 */
export const contextOf = (canvas, settings = {}) => canvas.getContext("2d", settings);

/** An SVG element with attributes. */
export function svgElement(tag, attributes) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

/** A 20 by 20 line icon. */
export function icon(path) {
  const svg = svgElement("svg", { viewBox: "0 0 20 20", "aria-hidden": "true" });
  svg.append(svgElement("path", { d: path }));
  return svg;
}

/** Sets an element's text only if it changes, to spare the layout. */
export function setText(target, text) {
  if (target.textContent !== text) target.textContent = text;
}

/**
 * Scrolls `box`, and nothing around it, so that `part` is in sight. `covered`: the height in pixels of a
 * sticky head at its top.
 */
export function scrollWithin(box, part, covered = 0) {
  const outer = box.getBoundingClientRect();
  const inner = part.getBoundingClientRect();
  const top = outer.top + covered;
  if (inner.top < top) box.scrollTop -= top - inner.top;
  else if (inner.bottom > outer.bottom) box.scrollTop += inner.bottom - outer.bottom;
}

/** Makes a change to the page; an element with the focus stays where it is in the window, or at least in sight. */
export function keepInPlace(focused, change) {
  const topOf = () => focused.getBoundingClientRect().top;
  const isOnPage = focused !== null && focused !== document.body;
  const before = isOnPage ? topOf() : 0;
  change();
  if (!isOnPage || !focused.isConnected || topOf() === before) return;
  const box = focused.closest(".side-body");
  if (box !== null) box.scrollTop += topOf() - before;
  if (topOf() !== before) scrollBy(0, topOf() - before);
  if (topOf() !== before) focused.scrollIntoView({ block: "nearest" });
}

/** Removes rows {element} from the end of a list, or makes them, until there are so many. */
export function setCount(list, rows, count, make) {
  while (rows.length > count) rows.pop().element.remove();
  while (rows.length < count) {
    const row = make(rows.length);
    rows.push(row);
    list.append(row.element);
  }
}

export function makeClosable(menu) {
  addEventListener("pointerdown", (event) => {
    if (menu.open && !menu.contains(event.target)) menu.open = false;
  });
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.open) return;
    event.preventDefault();
    menu.open = false;
    menu.querySelector("summary").focus();
  });
}
