/** All that was measured of the chosen human. */
import { h, type Child } from "../base/dom.js";
import { count, fixed, lambdaText, percent, UNKNOWN } from "../base/format.js";
import { dict, number, text } from "../base/read.js";
import type { Signal } from "../base/signal.js";
import { outcomeBar } from "../chart/outcomes.js";
import { faultedTooOften } from "./measures.js";
import type { Payload, Point } from "./payload.js";
import { axisSentence, isPassive, levelText, title } from "./words.js";

function entry(name: Child, value: Child, note?: Child): HTMLElement {
  return h("div", { class: "entry" }, h("dt", {}, name), h("dd", {}, value, note && h("small", {}, " ", note)));
}

function faultsText(point: Point): string {
  if (point.faults === null) return UNKNOWN;
  return point.episodes ? `${point.faults} of ${count(point.episodes)} episodes` : String(point.faults);
}

function searched(point: Point): HTMLElement {
  const converged = point.converged === null ? UNKNOWN : point.converged ? "yes" : "no";
  return h("dl", { class: "entries" },
    entry("λ", lambdaText(point.lambda)),
    entry("seed, round", `${point.seed ?? UNKNOWN}, ${point.round ?? UNKNOWN}`),
    entry("training steps", count(point.envSteps)),
    entry("training at rest", converged, point.converged === false && "(its return still moved; it counts all the same)"),
    entry("faults", faultsText(point)),
    entry("on the frontier", point.onFrontier ? "yes" : "no"));
}

function effect(point: Point, payload: Payload, physical: boolean): HTMLElement {
  const caveat = physical ? null : "not physical";
  const canonical = payload.canonical;
  return h("dl", { class: "entries" },
    entry("adversarialness", h("b", {}, fixed(point.adversarialness)), `canonical ${fixed(canonical.adversarialness)}`),
    entry("return", fixed(point.return, 1), `canonical ${fixed(canonical.return, 1)}`),
    entry("success", percent(point.success), `canonical ${percent(canonical.success)}`),
    point.peakForce !== null && entry("peak force", `${fixed(point.peakForce, 1)} N`, caveat),
    point.impulse !== null && entry("impulse", `${fixed(point.impulse, 1)} N·s`, caveat),
    point.verdict !== null && entry("a fresh robot", point.verdict, `regret ${fixed(point.regret)}`));
}

function naturalness(point: Point, payload: Payload): HTMLElement {
  const own = point.naturalnessOwn === null ? [] : [["its own discriminator", point.naturalnessOwn] as const];
  const rows = [...point.levels.map(([name, value]) => [levelText(name), value] as const), ...own];
  const bar = (value: number | null): HTMLElement =>
    h("span", { class: "meter" }, h("span", { style: `width: ${100 * Math.min(Math.max(value ?? 0, 0), 1)}%` }));
  return h("div", { class: "levels" },
    h("dl", { class: "entries" }, entry("naturalness", h("b", {}, fixed(point.naturalness)))),
    h("table", {}, h("caption", { class: "visually-hidden" }, "Naturalness at every level of the referee"),
      h("tbody", {}, ...rows.map(([name, value]) =>
        h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, bar(value)), h("td", { class: "number" }, fixed(value)))))),
    h("p", { class: "note" }, axisSentence(payload)));
}

/** Outcomes of a task that has its own names for them. */
function otherOutcomes({ raw }: Point): HTMLElement {
  const shares = Object.entries(dict(raw["outcomes"])).map(([name, share]) => [name, number(share)] as const);
  if (!shares.length) return h("p", { class: "empty" }, "Outcomes were not recorded.");
  return h("dl", { class: "entries" }, ...shares.map(([name, share]) => entry(name.replaceAll("_", " "), percent(share))));
}

function standing(point: Point): string {
  if (point.onFrontier) return "On the frontier.";
  return faultedTooOften(point)
    ? "Not on the frontier: more than 1 % of its episodes faulted."
    : "Dominated: another human is at least as natural and as harmful.";
}

function body(point: Point, payload: Payload, physical: boolean): Node[] {
  return [
    h("div", { class: "details-head", role: "status" },
      h("h2", { id: "chosen-title" }, title(point)),
      h("p", {}, isPassive(point)
        ? "An untrained human who does nothing: a reference, not an attack."
        : standing(point))),
    h("div", { class: "details-grid" },
      h("section", {}, h("h3", {}, "How natural"), naturalness(point, payload)),
      h("section", {}, h("h3", {}, "How bad"), effect(point, payload, physical)),
      h("section", {}, h("h3", {}, "How episodes ended"),
        point.outcomes ? outcomeBar(point.outcomes) : otherOutcomes(point),
        h("p", { class: "note" }, `${count(point.episodes)} fresh episodes`)),
      !isPassive(point) && h("section", {}, h("h3", {}, "How it was found"), searched(point))),
  ];
}

/** The section that follows the selection. */
export function details(payload: Payload, chosen: Signal<Point | null>, physical: boolean): HTMLElement {
  const section = h("section", { class: "details", "aria-labelledby": "chosen-title" });
  chosen.watch((point) => {
    section.dataset["point"] = text(point?.id);
    section.replaceChildren(...(point ? body(point, payload, physical)
      : [h("p", { class: "empty" }, "No human was measured.")]));
  });
  return section;
}
