/** Builds elements. Strings become text nodes, never markup, so foreign text is inert. */

export type Child = Node | string | number | null | undefined | false;
type Value = string | number | boolean | null | undefined;
type Handlers = { [K in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[K]) => void };

const SVG_NAMESPACE = "http://www.w3.org/2000/svg";

function fill(element: Element, attributes: Record<string, Value>, children: readonly Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    // Through the object model: a strict content policy refuses style attributes.
    if (name === "style") (element as HTMLElement | SVGElement).style.cssText = String(value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  append(element, children);
}

/** Appends children; null, undefined, false and "" are left out. */
export function append(parent: Node, children: readonly Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false || child === "") continue;
    parent.appendChild(child instanceof Node ? child : document.createTextNode(String(child)));
  }
}

/** An HTML element. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, Value> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  fill(element, attributes, children);
  return element;
}

/** An SVG element. */
export function s<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Record<string, Value> = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG_NAMESPACE, tag) as SVGElementTagNameMap[K];
  fill(element, attributes, children);
  return element;
}

/** Adds listeners and returns the element. */
export function on<E extends Element>(element: E, handlers: Handlers): E {
  for (const [type, handler] of Object.entries(handlers)) {
    element.addEventListener(type, handler as EventListener);
  }
  return element;
}

/** A button whose accessible name is its text, or `label` where the text is a symbol. */
export function button(
  text: Child,
  action: () => void,
  attributes: Record<string, Value> = {},
): HTMLButtonElement {
  return on(h("button", { type: "button", ...attributes }, text), { click: action });
}

/** Redraws into `host` whenever its width changes. */
export function responsive(host: HTMLElement, draw: (width: number) => Element): void {
  let last = 0;
  const redraw = (): void => {
    // On paper the drawings scale by their viewBox: a redraw during the print layout would be lost.
    const width = Math.floor(host.clientWidth);
    if (width === 0 || width === last || matchMedia("print").matches) return;
    last = width;
    host.replaceChildren(draw(width));
  };
  new ResizeObserver(redraw).observe(host);
}

/** A figure's caption: what is seen, what it does not say, and on screen what can be done. */
export function caption(shows: string, doesNot: string, hint = ""): HTMLElement {
  return h("figcaption", {}, shows, hint && h("span", { class: "hint" }, ` ${hint}`),
    doesNot && h("span", { class: "caveat" }, ` ${doesNot}`));
}
