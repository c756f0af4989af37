/** Strips over time with one playhead: what was measured during an episode. Drag to scrub. */
import { scaleLinear } from "d3-scale";
import { area, line } from "d3-shape";
import { h, on, responsive, s } from "../base/dom.js";

export interface StripSeries {
  readonly kind: string;
  readonly values: readonly number[];
  readonly filled?: boolean;
}

export interface Strip {
  readonly title: string;
  readonly series: readonly StripSeries[];
  /** The least upper limit of y, so that noise near zero stays small. */
  readonly atLeast: number;
  readonly format: (value: number) => string;
}

const HEIGHT = 34;

/** One strip: title, curve, and the value now of its first series. */
export class StripRow {
  readonly element: HTMLElement;
  readonly #value = h("output", { class: "strip-value" });
  readonly #head = s("line", { class: "playhead", y1: 0, y2: HEIGHT });
  #width = 0;
  #time = 0;

  constructor(
    private readonly strip: Strip,
    private readonly frames: number,
    seek: (time: number) => void,
  ) {
    const canvas = h("div", { class: "canvas strip-canvas" });
    this.element = h("div", { class: "strip" }, h("span", { class: "strip-title" }, strip.title), canvas, this.#value);
    responsive(canvas, (width) => this.#draw(width));
    const scrub = (event: PointerEvent): void => {
      const bounds = canvas.getBoundingClientRect();
      seek(((event.clientX - bounds.left) / bounds.width) * (frames - 1));
    };
    on(canvas, {
      pointerdown: (event) => {
        canvas.setPointerCapture(event.pointerId);
        scrub(event);
      },
      pointermove: (event) => {
        if (event.buttons & 1) scrub(event);
      },
    });
    this.seek(0);
  }

  #draw(width: number): SVGSVGElement {
    this.#width = width;
    const values = this.strip.series.flatMap((series) => series.values).filter(Number.isFinite);
    const top = Math.max(this.strip.atLeast, ...values);
    const x = scaleLinear([0, Math.max(1, this.frames - 1)], [1, width - 1]);
    const y = scaleLinear([0, top], [HEIGHT - 2, 3]);
    const svg = s("svg", {
      viewBox: `0 0 ${width} ${HEIGHT}`, width, height: HEIGHT, "aria-hidden": "true",
      preserveAspectRatio: "none",
    });
    svg.append(s("line", { class: "grid", x1: 0, x2: width, y1: HEIGHT - 1.5, y2: HEIGHT - 1.5 }));
    // The first series is the one that is read: it lies on top.
    for (const { kind, values: own, filled } of [...this.strip.series].reverse()) {
      if (filled) {
        const shape = area<number>((_, i) => x(i), y(0), (v) => y(v)).defined(Number.isFinite);
        svg.append(s("path", { class: `fill ${kind}`, d: shape(own) ?? "" }));
      }
      const curve = line<number>((_, i) => x(i), (v) => y(v)).defined(Number.isFinite);
      svg.append(s("path", { class: `series ${kind}`, d: curve(own) ?? "" }));
    }
    svg.append(this.#head);
    this.seek(this.#time);
    return svg;
  }

  /** Moves the playhead to `time` [frames]. */
  seek(time: number): void {
    this.#time = time;
    const x = 1 + (time / Math.max(1, this.frames - 1)) * (this.#width - 2);
    this.#head.setAttribute("transform", `translate(${x},0)`);
    this.#value.textContent = this.strip.format(this.strip.series[0]?.values[Math.round(time)] ?? NaN);
  }
}
