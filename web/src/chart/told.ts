/** How often one human's judges take each human of a seed for not canonical, by that human's λ. */
import { scaleLinear } from "d3-scale";
import { line } from "d3-shape";
import { h, responsive, s } from "../base/dom.js";
import { lambdaText, percent } from "../base/format.js";
import { axisTitle, root, xAxis, yAxis, type Box } from "./axes.js";
import type { XY } from "./hull.js";
import { interactive, type Mark } from "./marks.js";
import { axisBreak, lambdaAxis } from "./sweep.js";
import { Tooltip } from "./tooltip.js";

export interface ToldPoint {
  readonly id: string;
  readonly lambda: number;
  /** Share of its steps that the discriminator takes for not canonical; NaN where it is unknown. */
  readonly discriminator: number;
  readonly referee: number;
  /** A style attribute with the colour `--mark`. */
  readonly style: string;
  readonly label: string;
  readonly lines: readonly string[];
}

/** A panel; `chosen` is whose judges these are, and choosing a mark asks for another's. */
export function toldPanel(title: string, points: readonly ToldPoint[], chosen: string, choose: (id: string) => void): HTMLElement {
  const tooltip = new Tooltip();
  const canvas = h("div", { class: "canvas" });
  const sorted = [...points].sort((a, b) => a.lambda - b.lambda);
  responsive(canvas, (width) => {
    const box: Box = { width, height: 270, top: 30, right: 14, bottom: 46, left: 46 };
    const axis = lambdaAxis(sorted.map(({ lambda }) => lambda), box.left, width - box.right);
    const y = scaleLinear([0, 1], [box.height - box.bottom, box.top]);
    const at = ({ lambda }: ToldPoint, share: number): XY => [axis.place(lambda), y(share)];
    const svg = root(box, title, "group");
    const thread = (share: (point: ToldPoint) => number): string => line<ToldPoint>(
      (point) => axis.place(point.lambda), (point) => y(share(point))).defined((point) => Number.isFinite(share(point)))(sorted) ?? "";
    const refereed = sorted.filter(({ referee }) => Number.isFinite(referee));
    const marks = sorted.filter(({ discriminator }) => Number.isFinite(discriminator)).map((point): Mark => {
      const place = at(point, point.discriminator);
      return { id: point.id, at: place, element: drawMark(point, place) };
    });
    svg.append(
      yAxis(y, [0, 0.5, 1], box, percent),
      xAxis(axis.place, axis.ticks, box, lambdaText),
      ...axis.breaks.map((x) => axisBreak(x, box.height - box.bottom)),
      axisTitle("↑ taken for not canonical", 0, 14, "start"),
      axisTitle("λ of the human (log) →", width - box.right, box.height - 6, "end"),
      s("path", { class: "series told-thread", d: thread(({ discriminator }) => discriminator) }),
      ...refereed.slice(0, 1).map(() => s("path", { class: "series told-referee", d: thread(({ referee }) => referee) })),
      ...refereed.map((point) => refereeMark(at(point, point.referee))),
      ...marks.map(({ element }) => element),
    );
    interactive(marks, {
      choose,
      peek: (mark) => tooltip.show(mark.at, points.find(({ id }) => id === mark.id)?.lines ?? [], width),
      leave: () => tooltip.hide(),
    })(chosen);
    return svg;
  });
  return h("div", { class: "panel told" },
    h("div", { class: "panel-head" }, h("h4", {}, title)),
    h("div", { class: "chart" }, canvas, tooltip.element));
}

function drawMark(point: ToldPoint, [x, y]: XY): SVGGElement {
  return s("g",
    { class: "mark frontier", style: point.style, transform: `translate(${x},${y})`, "aria-label": point.label, "data-id": point.id },
    s("circle", { class: "hit", r: 11 }), s("circle", { class: "halo", r: 10 }),
    s("circle", { class: "shape", r: 5.5 }));
}

function refereeMark([x, y]: XY): SVGElement {
  return s("path", { class: "referee-mark", d: `M${x} ${y - 6}l6 6l-6 6l-6 -6Z`, "aria-hidden": "true" });
}
