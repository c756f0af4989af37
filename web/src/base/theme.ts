/** Dark and light: the system's choice until the reader makes one. */
import { button, h } from "./dom.js";
import { Signal } from "./signal.js";

export type Theme = "light" | "dark";

const system = matchMedia("(prefers-color-scheme: dark)");
const paper = matchMedia("print");

/** What is shown now; paper is always light. */
export const theme = new Signal<Theme>("light");

let chosen: Theme | null = null;

function update(): void {
  const next = chosen ?? (system.matches ? "dark" : "light");
  document.documentElement.dataset["theme"] = next;
  theme.value = paper.matches ? "light" : next;
}

/** The header's switch. */
export function themeSwitch(): HTMLElement {
  const toggle = button(h("span", { class: "theme-icon", "aria-hidden": "true" }), () => {
    chosen = document.documentElement.dataset["theme"] === "dark" ? "light" : "dark";
    update();
  });
  toggle.className = "quiet theme-switch";
  theme.watch((now) => toggle.setAttribute("aria-label", now === "dark" ? "Light theme" : "Dark theme"));
  return toggle;
}

/** The value of a CSS custom property that is a colour, resolved for the theme in force. */
export function themeColor(name: string): string {
  const probe = h("span", { style: `color: var(${name})` });
  document.body.append(probe);
  const color = getComputedStyle(probe).color;
  probe.remove();
  return color;
}

system.addEventListener("change", update);
paper.addEventListener("change", update);
update();
