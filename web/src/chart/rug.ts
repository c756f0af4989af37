/** Where some humans lie on the axis of naturalness: a line each, all others as dots. */
import { scaleLinear } from "d3-scale";
import { h, responsive, s } from "../base/dom.js";
import type { Signal } from "../base/signal.js";

export interface RugMark {
  readonly id: string;
  readonly naturalness: number;
}

const HEIGHT = 38;
const BASE = 24;
const TOP = 7;
const EDGE = 5;

/** A strip of fixed height; `example` is the member that stands out, `chosen` is marked as well. */
export function rug(
  label: string,
  members: readonly RugMark[],
  others: readonly RugMark[],
  example: string,
  chosen: Signal<string | null>,
): HTMLElement {
  const canvas = h("div", { class: "canvas rug" });
  let mark: (id: string | null) => void = () => undefined;
  responsive(canvas, (width) => {
    const x = scaleLinear([0, 1], [EDGE, width - EDGE]);
    const svg = s("svg", { viewBox: `0 0 ${width} ${HEIGHT}`, width, height: HEIGHT, role: "img", "aria-label": label });
    const drawn = members.map((member) => [member.id, line(member, x, member.id === example)] as const);
    svg.append(
      s("rect", { class: "natural", x: x(0.8), width: x(1) - x(0.8), y: TOP, height: BASE - TOP }),
      s("line", { class: "axis", x1: x(0), x2: x(1), y1: BASE, y2: BASE }),
      ...[0, 0.5, 1].map((tick) => s("text", { class: "tick", x: x(tick), y: HEIGHT - 1, "text-anchor": anchor(tick) }, String(tick))),
      ...others.map(({ naturalness }) => s("circle", { class: "rug-other", cx: x(naturalness), cy: BASE, r: 1.6 })),
      ...drawn.map(([, element]) => element),
    );
    mark = (id) => drawn.forEach(([own, element]) => element.classList.toggle("chosen", own === id));
    mark(chosen.value);
    return svg;
  });
  chosen.watch((id) => mark(id));
  return canvas;
}

function anchor(tick: number): string {
  return tick === 0 ? "start" : tick === 1 ? "end" : "middle";
}

/** The example has a head, so that it stands out without colour. */
function line({ naturalness }: RugMark, x: (v: number) => number, example: boolean): SVGElement {
  const at = x(Math.min(Math.max(naturalness, 0), 1));
  return s("g", { class: example ? "rug-line example" : "rug-line" },
    s("line", { x1: at, x2: at, y1: example ? TOP - 2 : TOP, y2: BASE }),
    example && s("circle", { cx: at, cy: TOP - 2, r: 3.4 }));
}
