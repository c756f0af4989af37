/** How far canonical motion is still recognised as noise rises: a line for each judge. */
import { scaleLinear } from "d3-scale";
import { line } from "d3-shape";
import { h, responsive, s } from "../base/dom.js";
import { lambdaText, percent } from "../base/format.js";
import { axisTitle, root, xAxis, yAxis, type Box } from "./axes.js";
import { readingLine } from "./cursor.js";
import { axisBreak, lambdaAxis } from "./sweep.js";

export interface NoiseLine {
  /** Named where it is read; lines without a name lie behind. */
  readonly name: string | null;
  readonly kind: "discriminator" | "referee" | "other";
  /** A style attribute with the colour `--mark`. */
  readonly style: string;
  /** A share for each level. */
  readonly values: readonly number[];
}

/** A panel: title, what the named lines say under the reading line, the chart. */
export function noisePanel(title: string, levels: readonly number[], lines: readonly NoiseLine[]): HTMLElement {
  const reading = h("output", { class: "reading" });
  const canvas = h("div", { class: "canvas" });
  const show = (index: number | null): void => {
    const at = index ?? 0;
    reading.replaceChildren(
      h("span", {}, `noise ${lambdaText(levels[at] ?? null)}`),
      ...lines.filter(({ name }) => name !== null).map(({ name, values }) =>
        h("span", {}, `${name} `, h("b", {}, percent(Number.isFinite(values[at]) ? values[at] as number : null)))));
  };
  show(null);
  responsive(canvas, (width) => draw(title, levels, lines, width, show));
  return h("div", { class: "panel told" }, h("div", { class: "panel-head" }, h("h4", {}, title), reading), canvas);
}

function draw(
  title: string,
  levels: readonly number[],
  lines: readonly NoiseLine[],
  width: number,
  show: (index: number | null) => void,
): SVGSVGElement {
  const box: Box = { width, height: 270, top: 30, right: 14, bottom: 46, left: 46 };
  const axis = lambdaAxis(levels, box.left, width - box.right);
  const y = scaleLinear([0, 1], [box.height - box.bottom, box.top]);
  const svg = root(box, title);
  const path = line<number>((_, i) => axis.place(levels[i] ?? 0), (v) => y(v)).defined(Number.isFinite);
  svg.append(
    yAxis(y, [0, 0.5, 1], box, percent),
    xAxis(axis.place, axis.ticks, box, lambdaText),
    ...axis.breaks.map((x) => axisBreak(x, box.height - box.bottom)),
    axisTitle("↑ taken for canonical", 0, 14, "start"),
    axisTitle("noise [canonical σ] →", width - box.right, box.height - 6, "end"),
    ...lines.map(({ kind, style, values }) => s("path", { class: `series told-${kind}`, style, d: path(values) ?? "" })),
  );
  readingLine(svg, box, levels.map(axis.place), show);
  return svg;
}
