/** How the chosen human learned, and how its discriminator fared. */
import { caption, h } from "../base/dom.js";
import { dict } from "../base/read.js";
import type { Signal } from "../base/signal.js";
import { linePanel } from "../chart/lines.js";
import { discriminatorFigures } from "./discriminator-figures.js";
import { panelsOf } from "./learning-panels.js";
import type { Payload, Point } from "./payload.js";

/** The section that follows the selection; `choose` asks for another human. */
export function learning(payload: Payload, chosen: Signal<Point | null>, choose: (id: string) => void): HTMLElement {
  const grid = h("div", { class: "panels" });
  const told = h("div", { class: "told-figures" });
  chosen.watch((point) => {
    const stored = point !== null && Object.hasOwn(payload.learning, point.id);
    const panels = stored ? panelsOf(dict(payload.learning[point.id])) : [];
    grid.replaceChildren(...(panels.length ? panels.map(linePanel)
      : [h("p", { class: "empty" }, "No learning curves were stored for this human.")]));
    told.replaceChildren(...discriminatorFigures(payload, point, choose));
  });
  return h("section", { class: "band-section" },
    h("h2", {}, "How it learned, and its discriminator"),
    h("figure", {}, grid,
      caption(
        "Training of the chosen human (of the λ nearest to it, where λ share a network): the return it left the robot, and the discriminator (−1 canonical, +1 adversary) that held its motion close.",
        "This discriminator is the search's own and differs from run to run; naturalness on the frontier is the referee's. An accuracy near one half can mean a natural human or a weak discriminator.",
      )),
    h("h3", { class: "told-title" }, "What its discriminator tells apart"),
    told);
}
