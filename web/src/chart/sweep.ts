/** Where the search looked: naturalness against λ, round by round (paper, Fig. 3d-e). */
import { scaleLinear, scaleLog } from "d3-scale";
import { line, symbol, symbolCircle, symbolSquare2, symbolTriangle } from "d3-shape";
import { h, responsive, s } from "../base/dom.js";
import { lambdaText } from "../base/format.js";
import type { Signal } from "../base/signal.js";
import { axisTitle, root, xAxis, yAxis, type Box } from "./axes.js";
import type { XY } from "./hull.js";
import { interactive } from "./marks.js";
import { Tooltip } from "./tooltip.js";

export interface SweepPoint {
  readonly id: string;
  readonly seed: number | null;
  readonly round: number | null;
  readonly lambda: number;
  readonly naturalness: number;
  readonly label: string;
  readonly lines: readonly string[];
}

const SHAPES = [symbolCircle, symbolTriangle, symbolSquare2];
const END_SLOT = 44;

/** Rounds in order of appearance, ascending. */
export function roundsOf(points: readonly { readonly round: number | null }[]): number[] {
  return [...new Set(points.flatMap(({ round }) => round ?? []))].sort((a, b) => a - b);
}

/** λ → px: logarithmic, with slots of their own for 0 at the left and ∞ at the right. */
export function lambdaAxis(
  lambdas: readonly number[],
  left: number,
  right: number,
): { readonly place: (lambda: number) => number; readonly ticks: readonly number[]; readonly breaks: readonly number[] } {
  const finite = lambdas.filter((v) => v > 0 && v < Infinity);
  const from = left + (lambdas.includes(0) ? END_SLOT : 14);
  const to = right - (lambdas.includes(Infinity) ? END_SLOT : 14);
  const low = Math.min(...finite);
  const high = Math.max(...finite);
  const log = finite.length && low < high ? scaleLog([low, high], [from, to]) : () => (from + to) / 2;
  const place = (v: number): number => (v === 0 ? left + 14 : v === Infinity ? right - 14 : log(v));
  const decades = finite.length ? decadesBetween(low, high) : [];
  const ticks = [...(lambdas.includes(0) ? [0] : []), ...decades, ...(lambdas.includes(Infinity) ? [Infinity] : [])];
  const breaks = [
    ...(lambdas.includes(0) ? [left + END_SLOT / 2 + 4] : []),
    ...(lambdas.includes(Infinity) ? [right - END_SLOT / 2 - 4] : []),
  ];
  return { place, ticks, breaks };
}

function decadesBetween(low: number, high: number): number[] {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  if (last < first) return [low];
  return Array.from({ length: last - first + 1 }, (_, i) => Number(`1e${first + i}`));
}

/** Fills `host` with the chart. */
export function sweepChart(host: HTMLElement, points: readonly SweepPoint[], chosen: Signal<string | null>): void {
  const tooltip = new Tooltip();
  const canvas = h("div", { class: "canvas" });
  host.append(canvas, tooltip.element);
  const rounds = roundsOf(points);
  let select: (id: string | null) => void = () => undefined;

  responsive(canvas, (width) => {
    const box: Box = { width, height: width < 480 ? 280 : 320, top: 30, right: 14, bottom: 46, left: 38 };
    const axis = lambdaAxis(points.map((p) => p.lambda), box.left, width - box.right);
    const y = scaleLinear([0, 1], [box.height - box.bottom, box.top]);
    const at = (p: SweepPoint): XY => [axis.place(p.lambda), y(p.naturalness)];
    const svg = root(box, "Naturalness against λ, by round of the search", "group");
    svg.append(
      yAxis(y, [0, 0.5, 1], box, String),
      xAxis(axis.place, axis.ticks, box, lambdaText),
      ...axis.breaks.map((x) => axisBreak(x, box.height - box.bottom)),
      axisTitle("↑ naturalness", 0, 14, "start"),
      axisTitle("λ, weight on staying natural (log) →", width - box.right, box.height - 6, "end"),
      ...threads(points, at),
    );
    const marks = points.map((point) => {
      const [px, py] = at(point);
      const round = rounds.indexOf(point.round ?? NaN);
      const shape = SHAPES[Math.max(0, round) % SHAPES.length] ?? symbolCircle;
      const element = s("g",
        { class: `mark round round-${Math.max(0, round) % 4}`, transform: `translate(${px},${py})`,
          "aria-label": point.label },
        s("circle", { class: "hit", r: 10 }), s("circle", { class: "halo", r: 9 }),
        s("path", { class: "shape", d: symbol(shape, 46)() ?? "" }));
      return { id: point.id, element, at: [px, py] as XY };
    });
    svg.append(...marks.map(({ element }) => element));
    select = interactive(marks, {
      choose: (id) => (chosen.value = id),
      peek: (mark) => tooltip.show(mark.at, points.find(({ id }) => id === mark.id)?.lines ?? [], width),
      leave: () => tooltip.hide(),
    });
    select(chosen.value);
    return svg;
  });
  chosen.watch((id) => select(id));
}

/** Two short slashes: the axis is not continuous here. */
export function axisBreak(x: number, y: number): SVGElement {
  return s("g", { class: "break", "aria-hidden": "true" },
    s("rect", { x: x - 3, y: y - 2, width: 6, height: 4 }),
    s("path", { d: `M${x - 5} ${y + 5}l4 -10M${x + 1} ${y + 5}l4 -10` }));
}

/** A thin line per seed through its λ's. */
function threads(points: readonly SweepPoint[], at: (p: SweepPoint) => XY): SVGElement[] {
  const seeds = new Set(points.map(({ seed }) => seed));
  return [...seeds].map((seed) => {
    const own = points.filter((p) => p.seed === seed).sort((a, b) => a.lambda - b.lambda);
    return s("path", { class: "thread", d: line()(own.map((p) => [...at(p)])) ?? "" });
  });
}
