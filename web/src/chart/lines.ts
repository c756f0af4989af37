/** Small line panels with a shared reading line; arrow keys move it. */
import { extent } from "d3-array";
import { scaleLinear } from "d3-scale";
import { line } from "d3-shape";
import { h, responsive, s } from "../base/dom.js";
import { root, xAxis, yAxis, type Box } from "./axes.js";
import { readingLine } from "./cursor.js";

export interface Series {
  readonly name: string;
  /** CSS class that gives the colour. */
  readonly kind: string;
  readonly values: readonly number[];
}

export interface Panel {
  readonly title: string;
  readonly x: readonly number[];
  readonly xName: string;
  readonly series: readonly Series[];
  /** Fixed limits of y; otherwise those of the data. */
  readonly domain?: readonly [number, number];
  readonly format: (value: number) => string;
}

const finite = (v: number): boolean => Number.isFinite(v);

/** A panel: its title, the values under the reading line, the curves. */
export function linePanel(panel: Panel): HTMLElement {
  const reading = h("output", { class: "reading" });
  const canvas = h("div", { class: "canvas" });
  const element = h("div", { class: "panel" },
    h("div", { class: "panel-head" }, h("h4", {}, panel.title), reading), canvas);
  const show = (index: number | null): void => {
    reading.replaceChildren(...readings(panel, index));
  };
  show(null);
  responsive(canvas, (width) => draw(panel, width, show));
  return element;
}

function readings(panel: Panel, index: number | null): Node[] {
  const at = index ?? panel.x.length - 1;
  const parts: Node[] = panel.series.map(({ name, kind, values }) =>
    h("span", { class: `key ${kind}` }, name ? `${name} ` : "", h("b", {}, panel.format(values[at] ?? NaN))),
  );
  if (index !== null) parts.unshift(h("span", {}, `${panel.xName} ${panel.x[at] ?? ""}`));
  return parts;
}

function draw(panel: Panel, width: number, show: (index: number | null) => void): SVGSVGElement {
  const box: Box = { width, height: 150, top: 10, right: 8, bottom: 26, left: 40 };
  const all = panel.series.flatMap(({ values }) => values).filter(finite);
  const [low = 0, high = 1] = panel.domain ?? (extent(all) as [number, number]);
  const x = scaleLinear(extent(panel.x) as [number, number], [box.left, width - box.right]);
  const y = scaleLinear([low, high], [box.height - box.bottom, box.top]);
  if (!panel.domain) y.nice(3);
  const svg = root(box, `${panel.title}: ${panel.series.map(({ name }) => name).filter(Boolean).join(", ")}`);
  svg.append(
    yAxis(y, y.ticks(3), box, panel.format),
    xAxis(x, x.ticks(Math.max(2, Math.floor(width / 90))), box, String),
    ...panel.series.map(({ kind, values }) => {
      const path = line<number>((_, i) => x(panel.x[i] ?? 0), (v) => y(v)).defined(finite);
      return s("path", { class: `series ${kind}`, d: path(values) ?? "" });
    }),
  );
  readingLine(svg, box, panel.x.map((v) => x(v)), show);
  return svg;
}
