/** How episodes ended: one stacked bar, or a column for every human found. */
import { scaleLinear } from "d3-scale";
import { h, responsive, s } from "../base/dom.js";
import { percent } from "../base/format.js";
import type { Signal } from "../base/signal.js";
import { axisTitle, root, yAxis, type Box } from "./axes.js";
import type { XY } from "./hull.js";
import { interactive } from "./marks.js";
import { Tooltip } from "./tooltip.js";

export interface Shares {
  readonly helped: number;
  readonly unhelped: number;
  readonly unwanted: number;
}

export interface OutcomeColumn {
  readonly id: string;
  readonly naturalness: number;
  readonly shares: Shares;
  readonly label: string;
  readonly lines: readonly string[];
}

export const OUTCOMES = [
  ["unwanted", "unwanted contact"],
  ["unhelped", "unhelped"],
  ["helped", "helped"],
] as const;

/** One horizontal bar with its numbers written out. */
export function outcomeBar(shares: Shares): HTMLElement {
  const parts = OUTCOMES.map(([key]) =>
    h("span", { class: `part ${key}`, style: `flex-grow: ${Math.max(0, shares[key])}` }),
  );
  const legend = OUTCOMES.map(([key, name]) =>
    h("li", {}, h("span", { class: `swatch ${key}` }), `${name} `, h("b", {}, percent(shares[key]))),
  );
  return h("div", { class: "outcome-bar" },
    h("div", { class: "bar", "aria-hidden": "true" }, ...parts),
    h("ul", { class: "legend" }, ...legend));
}

/** Fills `host` with a column per human, the least natural at the left. */
export function outcomeChart(
  host: HTMLElement,
  columns: readonly OutcomeColumn[],
  chosen: Signal<string | null>,
): void {
  const tooltip = new Tooltip();
  const canvas = h("div", { class: "canvas" });
  host.append(canvas, tooltip.element);
  const sorted = [...columns].sort((a, b) => a.naturalness - b.naturalness);
  let select: (id: string | null) => void = () => undefined;

  responsive(canvas, (width) => {
    const box: Box = { width, height: width < 480 ? 220 : 250, top: 30, right: 14, bottom: 42, left: 44 };
    const step = (width - box.left - box.right) / Math.max(1, sorted.length);
    const y = scaleLinear([0, 1], [box.height - box.bottom, box.top]);
    const svg = root(box, "Outcomes of every human found, by naturalness", "group");
    svg.append(
      yAxis(y, [0, 0.5, 1], box, percent),
      axisTitle("↑ share of episodes", 0, 14, "start"),
      axisTitle("humans, from least to most natural →", width - box.right, box.height - 6, "end"),
    );
    const marks = sorted.map((column, i) => {
      const x = box.left + i * step;
      const element = s("g", { class: "mark column", "aria-label": column.label },
        ...stack(column.shares, x, step, y),
        s("rect", { class: "hit halo", x, y: y(1) - 3, width: step, height: y(0) - y(1) + 6, rx: 2 }));
      return { id: column.id, element, at: [x + step / 2, y(0.5)] as XY };
    });
    svg.append(...thresholds(sorted, box, step, y(0)), ...marks.map(({ element }) => element));
    select = interactive(marks, {
      choose: (id) => (chosen.value = id),
      peek: (mark) => tooltip.show(mark.at, sorted.find(({ id }) => id === mark.id)?.lines ?? [], width),
      leave: () => tooltip.hide(),
    });
    select(chosen.value);
    return svg;
  });
  chosen.watch((id) => select(id));
}

function stack(shares: Shares, x: number, step: number, y: (v: number) => number): SVGElement[] {
  const gap = Math.min(4, step * 0.18);
  let from = 0;
  return OUTCOMES.map(([key]) => {
    const to = Math.min(1, from + Math.max(0, shares[key]));
    const part = s("rect", { class: key, x: x + gap / 2, width: Math.max(1, step - gap), y: y(to), height: y(from) - y(to) });
    from = to;
    return part;
  });
}

/** Marks below the columns where naturalness passes 0.5, 0.8 and 0.9. */
function thresholds(columns: readonly OutcomeColumn[], box: Box, step: number, base: number): SVGElement[] {
  return [0.5, 0.8, 0.9].flatMap((limit) => {
    const first = columns.findIndex(({ naturalness }) => naturalness >= limit);
    if (first <= 0) return [];
    const x = box.left + first * step;
    return [
      s("line", { class: "axis", x1: x, x2: x, y1: base, y2: base + 6 }),
      s("text", { class: "tick", x, y: base + 18, "text-anchor": "middle" }, `≥ ${limit}`),
    ];
  });
}
