/** A small card beside a mark. Screen readers get the mark's own label instead. */
import { h, type Child } from "../base/dom.js";
import type { XY } from "./hull.js";

export class Tooltip {
  readonly element = h("div", { class: "tooltip", "aria-hidden": "true", hidden: true });

  /** Shows `lines` beside a point of the host [px], on the side where there is room. */
  show([x, y]: XY, lines: readonly Child[], hostWidth: number): void {
    this.element.replaceChildren(...lines.map((line) => h("div", {}, line)));
    this.element.hidden = false;
    const width = this.element.offsetWidth;
    const left = x + 14 + width > hostWidth ? Math.max(0, x - 14 - width) : x + 14;
    const top = Math.max(0, y - this.element.offsetHeight / 2);
    this.element.style.transform = `translate(${left}px, ${top}px)`;
  }

  hide(): void {
    this.element.hidden = true;
  }
}
