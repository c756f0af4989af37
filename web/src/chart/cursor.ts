/** A reading line that follows the pointer over a chart; arrow keys move it too. */
import { bisectCenter } from "d3-array";
import { on, s } from "../base/dom.js";
import type { Box } from "./axes.js";

/**
 * Gives `svg` a reading line; `show` hears where it stands.
 *
 * @param positions Where it can stand [px], ascending.
 * @param show Called with an index into `positions`, or with null when the reader has left.
 */
export function readingLine(
  svg: SVGSVGElement,
  box: Box,
  positions: readonly number[],
  show: (index: number | null) => void,
): void {
  const line = s("line", { class: "cursor", y1: box.top, y2: box.height - box.bottom, visibility: "hidden" });
  svg.append(line);
  svg.setAttribute("tabindex", "0");
  let index = positions.length - 1;
  const move = (next: number): void => {
    index = Math.min(Math.max(next, 0), positions.length - 1);
    const px = String(positions[index] ?? 0);
    line.setAttribute("x1", px);
    line.setAttribute("x2", px);
    line.setAttribute("visibility", "visible");
    show(index);
  };
  const leave = (): void => {
    line.setAttribute("visibility", "hidden");
    show(null);
  };
  on(svg, {
    pointermove: (event) => {
      const bounds = svg.getBoundingClientRect();
      const scale = svg.viewBox.baseVal.width / bounds.width;
      move(bisectCenter([...positions], (event.clientX - bounds.left) * scale));
    },
    pointerleave: leave,
    blur: leave,
    keydown: (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      move(index + step);
    },
  });
}
