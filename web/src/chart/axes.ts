/** Quiet axes: hairlines, few ticks, titles written level. */
import { s } from "../base/dom.js";

export interface Box {
  readonly width: number;
  readonly height: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly left: number;
}

export type Scale = (value: number) => number;

/** An SVG root that keeps its text size on screen and scales on paper. */
export function root(box: Box, label: string, role: "group" | "img" = "img"): SVGSVGElement {
  const { width, height } = box;
  return s("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role, "aria-label": label });
}

/** Horizontal hairlines with their numbers at the left. */
export function yAxis(
  scale: Scale,
  ticks: readonly number[],
  box: Box,
  format: (value: number) => string,
): SVGGElement {
  const rows = ticks.map((tick) => {
    const y = scale(tick);
    return s("g", {},
      s("line", { class: "grid", x1: box.left, x2: box.width - box.right, y1: y, y2: y }),
      s("text", { class: "tick", x: box.left - 8, y, dy: "0.32em", "text-anchor": "end" }, format(tick)));
  });
  return s("g", { "aria-hidden": "true" }, ...rows);
}

/** Numbers below the plot, with short ticks. */
export function xAxis(
  scale: Scale,
  ticks: readonly number[],
  box: Box,
  format: (value: number) => string,
): SVGGElement {
  const y = box.height - box.bottom;
  const marks = ticks.map((tick) =>
    s("g", {},
      s("line", { class: "axis", x1: scale(tick), x2: scale(tick), y1: y, y2: y + 5 }),
      s("text", { class: "tick", x: scale(tick), y: y + 19, "text-anchor": "middle" }, format(tick))),
  );
  const line = s("line", { class: "axis", x1: box.left, x2: box.width - box.right, y1: y, y2: y });
  return s("g", { "aria-hidden": "true" }, line, ...marks);
}

/** An axis title; the y title sits above the numbers, so that nothing is read sideways. */
export function axisTitle(text: string, x: number, y: number, anchor: "start" | "end"): SVGTextElement {
  return s("text", { class: "axis-title", x, y, "text-anchor": anchor, "aria-hidden": "true" }, text);
}
