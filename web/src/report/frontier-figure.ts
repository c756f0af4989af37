/** The figure with the frontier: chart, key, caption. */
import { frontierChart, type FrontierData, type FrontierMark } from "../chart/frontier.js";
import { lambdaGradient, lambdaRange, lambdaShare, lambdaStyle } from "../chart/palette.js";
import { caption, h, s } from "../base/dom.js";
import { fixed, general, lambdaText } from "../base/format.js";
import { interval } from "../base/read.js";
import type { Signal } from "../base/signal.js";
import { seedsOf } from "./measures.js";
import type { Payload, Point } from "./payload.js";
import { axisSentence, isPassive, label, lines, rangeSource, watchable } from "./words.js";

function markOf(point: Point, range: readonly [number, number]): FrontierMark[] {
  const { naturalness: x, adversarialness: y } = point;
  if (x === null || y === null) return [];
  const kind = isPassive(point) ? "passive" : point.onFrontier ? "frontier" : "dominated";
  const style = kind === "passive" ? "" : lambdaStyle(lambdaShare(point.lambda, range));
  return [{ id: point.id, at: [x, y], kind, style, label: label(point), lines: lines(point) }];
}

function dataOf(payload: Payload, range: readonly [number, number]): FrontierData {
  const { adversarialness: y, success } = payload.canonical;
  const all = payload.passive ? [...payload.points, payload.passive] : payload.points;
  const marks = all.flatMap((point) => markOf(point, range));
  // Marks drawn later lie on top.
  const order = { dominated: 0, passive: 1, frontier: 2 };
  return {
    marks: marks.sort((a, b) => order[a.kind] - order[b.kind]),
    canonical: y === null ? null : {
      at: [1, y],
      lines: ["canonical play", `adversarialness ${fixed(y)}`, `success ${fixed(success)}`],
    },
    band: payload.band,
    pooled: seedsOf(payload).length > 1,
  };
}

function sample(kind: string, path: string): SVGSVGElement {
  return s("svg", { class: `sample ${kind}`, viewBox: "-10 -8 20 16", width: 20, height: 16, "aria-hidden": "true" },
    s("path", { d: path }));
}

function key(payload: Payload, range: readonly [number, number]): HTMLElement {
  const [low, high] = range;
  const several = seedsOf(payload).length > 1;
  const lambdas = payload.points.map(({ lambda }) => lambda);
  const scale = h("div", { class: "lambda-scale" },
    h("span", {}, lambdas.includes(0) ? "λ = 0" : `λ ${lambdaText(low)}`),
    ...(["light", "dark"] as const).map((theme) =>
      h("span", { class: `ramp ${theme}`, style: `background: ${lambdaGradient(theme)}` })),
    h("span", {}, lambdas.includes(Infinity) ? "∞" : lambdaText(high)),
    h("span", { class: "what" }, "weight on staying natural"));
  return h("div", { class: "chart-key" }, scale,
    h("ul", { class: "legend" },
      h("li", {}, sample("frontier", "M5.5 0A5.5 5.5 0 1 1 -5.5 0A5.5 5.5 0 1 1 5.5 0Z"), "not dominated"),
      h("li", {}, sample("dominated", "M-4 -4L4 4M-4 4L4 -4"), "dominated"),
      h("li", {}, sample("canonical", "M0 -6L6 5H-6Z"), "canonical play"),
      payload.passive && h("li", {}, sample("passive", "M0 -6L6 0L0 6L-6 0Z"), "passive human: a reference, not an attack"),
      payload.band && h("li", {}, sample("mean", "M-9 0H9"), several ? "hull, mean over seeds" : "hull"),
      payload.band?.low && h("li", {}, sample("band", "M-9 -5H9V5H-9Z"), "95 % interval"),
      several && h("li", {}, sample("pooled", "M-9 0H9"), "outermost, seeds pooled"),
      h("li", {}, sample("natural", "M-9 -6H9V6H-9Z"), "naturalness ≥ 0.8")));
}

function frontierCaption(payload: Payload): HTMLElement {
  const range = interval(payload.frontier["return_range"]);
  const scale = range
    ? ` Adversarialness 0 and 1 stand for returns of ${general(range[1])} and ${general(range[0])} (${rangeSource(payload.frontier)}).`
    : "";
  const several = seedsOf(payload).length > 1;
  const line = several ? "the mean of the hulls of all seeds" : "the hull";
  const frontier = `A mark that is not dominated is on the frontier: no other human is both more natural and more adversarial. It need not touch the line, ${line}${several ? ", and the worst of one seed may lie above it" : ""}.`;
  return caption(
    `Each mark but the diamond and the triangle is one human policy, trained against this frozen robot and judged on fresh episodes by a referee that took no part in its training.${scale} ${frontier}`,
    `${axisSentence(payload)} The boundary is what this search found, not the worst there is.`.trim(),
    `Choose a round mark or a cross to ${watchable(payload) ? "watch it" : "read its numbers"}; arrow keys walk from mark to mark, Enter chooses.`,
  );
}

/** The whole figure. */
export function frontierFigure(payload: Payload, chosen: Signal<string | null>): HTMLElement {
  const range = lambdaRange(payload.points.map(({ lambda }) => lambda));
  const host = h("div", { class: "chart frontier-chart" });
  frontierChart(host, dataOf(payload, range), chosen);
  return h("figure", { class: "frontier-figure" }, host, key(payload, range), frontierCaption(payload));
}
