/** The natural-adversarial plane: every human found, the boundary, and what is known of its error. */
import { scaleLinear } from "d3-scale";
import { area, line, symbol, symbolDiamond2, symbolTimes, symbolTriangle } from "d3-shape";
import { h, responsive, s } from "../base/dom.js";
import type { Signal } from "../base/signal.js";
import { axisTitle, root, xAxis, yAxis, type Box } from "./axes.js";
import { upperHull, type XY } from "./hull.js";
import { interactive, seeThrough, type Mark } from "./marks.js";
import { Tooltip } from "./tooltip.js";

export interface FrontierMark {
  readonly id: string;
  readonly at: XY;
  readonly kind: "frontier" | "dominated" | "passive";
  /** A style attribute with the colour `--mark`. */
  readonly style: string;
  readonly label: string;
  readonly lines: readonly string[];
}

/** Stands in the plane without being a human that was found. */
interface Reference {
  readonly at: XY;
  readonly lines: readonly string[];
}

export interface FrontierData {
  readonly marks: readonly FrontierMark[];
  readonly canonical: Reference | null;
  readonly band: {
    readonly x: readonly number[];
    readonly mean: readonly number[];
    readonly low: readonly number[] | null;
    readonly high: readonly number[] | null;
  } | null;
  /** Whether a pooled boundary differs from the mean: more than one seed. */
  readonly pooled: boolean;
}

const TICKS = [0, 0.2, 0.4, 0.6, 0.8, 1];
const NATURAL = 0.8;

function pathOf(kind: FrontierMark["kind"]): string {
  if (kind === "dominated") return symbol(symbolTimes, 44)() ?? "";
  if (kind === "passive") return symbol(symbolDiamond2, 90)() ?? "";
  return "M6 0A6 6 0 1 1 -6 0A6 6 0 1 1 6 0Z";
}

/** Fills `host` with the chart; `chosen` is both read and written. */
export function frontierChart(host: HTMLElement, data: FrontierData, chosen: Signal<string | null>): void {
  const tooltip = new Tooltip();
  const canvas = h("div", { class: "canvas" });
  host.append(canvas, tooltip.element);
  let select: (id: string | null) => void = () => undefined;
  let guide: (id: string | null) => void = () => undefined;

  responsive(canvas, (width) => {
    const box: Box = {
      width, height: Math.round(Math.min(560, Math.max(320, width * 0.86))),
      top: 34, right: 14, bottom: 46, left: 38,
    };
    const x = scaleLinear([0, 1], [box.left, width - box.right]);
    const y = scaleLinear([0, 1], [box.height - box.bottom, box.top]);
    const place = ([a, b]: XY): XY => [x(a), y(b)];

    const svg = root(box, "Naturalness against adversarialness of every human found", "group");
    svg.append(
      s("rect", { class: "natural", x: x(NATURAL), y: y(1), width: x(1) - x(NATURAL), height: y(0) - y(1) }),
      yAxis(y, TICKS, box, String),
      xAxis(x, TICKS, box, String),
      axisTitle("↑ adversarialness", 0, 14, "start"),
      axisTitle("naturalness →", width - box.right, box.height - 6, "end"),
      ...boundary(data, place),
    );
    const guides = s("g", { class: "guides", "aria-hidden": "true" });
    const marks = data.marks.map((mark) => drawMark(mark, place(mark.at)));
    const references = data.canonical ? [anchor(data.canonical, place)] : [];
    const above = references.map(({ element }) => element);
    svg.append(guides, ...marks.map(({ element }) => element), ...above);

    const choose = (id: string): void => { chosen.value = id; };
    const leave = (): void => tooltip.hide();
    select = interactive(marks, {
      choose,
      peek: (mark, others) => {
        const lines = data.marks.find(({ id }) => id === mark.id)?.lines ?? [];
        tooltip.show(mark.at, others ? [...lines, `${others} more below: click again for the next`] : lines, width);
      },
      leave,
    });
    for (const { element, at, lines } of references) {
      const peek = (covered: number): void =>
        tooltip.show(at, covered ? [...lines, `${covered} found below: click for the next`] : lines, width);
      seeThrough(element, marks, { choose, peek, leave });
    }
    guide = (id) => {
      const mark = marks.find((m) => m.id === id);
      guides.replaceChildren(...(mark ? crosshair(mark.at, box) : []));
      if (mark && !mark.element.matches(":focus")) svg.append(mark.element, ...above);
    };
    select(chosen.value);
    guide(chosen.value);
    return svg;
  });
  chosen.watch((id) => {
    select(id);
    guide(id);
  });
}

function boundary(data: FrontierData, place: (at: XY) => XY): SVGElement[] {
  const drawn: SVGElement[] = [];
  const { band } = data;
  if (band?.low && band.high) {
    const { x, low, high } = band;
    const shape = area<number>((i) => place([x[i] ?? 0, 0])[0],
      (i) => place([0, low[i] ?? 0])[1], (i) => place([0, high[i] ?? 0])[1]);
    drawn.push(s("path", { class: "band", d: shape(x.keys()) ?? "" }));
  }
  const outermost = data.marks.filter(({ kind }) => kind === "frontier").map(({ at }) => at);
  if (data.canonical) outermost.push(data.canonical.at);
  if (data.pooled || !band) {
    drawn.push(s("path", { class: "pooled", d: line()(upperHull(outermost).map((p) => [...place(p)])) ?? "" }));
  }
  if (band) {
    const curve = band.x.map((v, i) => [...place([v, band.mean[i] ?? 0])] as [number, number]);
    drawn.push(s("path", { class: "mean", d: line()(curve) ?? "" }));
  }
  return drawn;
}

function drawMark(mark: FrontierMark, at: XY): Mark {
  const element = s("g",
    { class: `mark ${mark.kind}`, style: mark.style, transform: `translate(${at[0]},${at[1]})`,
      "aria-label": mark.label, "data-id": mark.id },
    s("circle", { class: "hit", r: 11 }),
    s("circle", { class: "halo", r: 10.5 }),
    s("path", { class: "shape", d: pathOf(mark.kind) }));
  return { id: mark.id, element, at };
}

function anchor({ at: there, lines }: Reference, place: (at: XY) => XY): Reference & { readonly element: SVGElement } {
  const at = place(there);
  const element = s("g",
    { class: "mark canonical", transform: `translate(${at[0]},${at[1]})`, role: "img",
      "aria-label": lines.join(", ") },
    s("circle", { class: "hit", r: 11 }),
    s("path", { class: "shape", d: symbol(symbolTriangle, 110)() ?? "" }));
  return { at, lines, element };
}

function crosshair([x, y]: XY, box: Box): SVGElement[] {
  return [
    s("line", { x1: x, x2: x, y1: y, y2: box.height - box.bottom }),
    s("line", { x1: box.left, x2: x, y1: y, y2: y }),
  ];
}
