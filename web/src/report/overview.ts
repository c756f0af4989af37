/** Figures over all humans found: how episodes ended, and where the search looked. */
import { caption, h } from "../base/dom.js";
import { percent } from "../base/format.js";
import type { Signal } from "../base/signal.js";
import { OUTCOMES, outcomeChart, type OutcomeColumn } from "../chart/outcomes.js";
import { roundsOf, sweepChart, type SweepPoint } from "../chart/sweep.js";
import type { Payload, Point } from "./payload.js";
import { label, lines, title } from "./words.js";

function columnOf(point: Point): OutcomeColumn[] {
  const { outcomes: shares, naturalness } = point;
  if (!shares || naturalness === null) return [];
  const parts = OUTCOMES.map(([key, name]) => `${name} ${percent(shares[key])}`);
  return [{
    id: point.id, naturalness, shares,
    label: `${title(point)}, naturalness ${naturalness.toFixed(2)}, ${parts.join(", ")}`,
    lines: [title(point), `naturalness ${naturalness.toFixed(2)}`, ...parts],
  }];
}

/** How episodes ended for every human. */
export function endings(payload: Payload, chosen: Signal<string | null>): HTMLElement {
  const columns = payload.points.flatMap(columnOf);
  if (!columns.length) {
    return h("section", { class: "band-section" },
      h("h2", {}, "How episodes ended"),
      h("p", { class: "empty" }, "This task has outcomes of its own: each human's stand above, where it is chosen."));
  }
  const host = h("div", { class: "chart" });
  outcomeChart(host, columns, chosen);
  const key = OUTCOMES.map(([kind, name]) => h("li", {}, h("span", { class: `swatch ${kind}` }), name));
  return h("section", { class: "band-section" },
    h("h2", {}, "How episodes ended"),
    h("figure", {}, h("ul", { class: "legend" }, ...key), host,
      caption(
        "One column for every human found, the least natural at the left: how its episodes ended.",
        "An episode has one outcome, by the task's own rule; a column says nothing of how hard a contact was.",
      )));
}

function sweepPointOf(point: Point): SweepPoint[] {
  const { lambda, naturalness } = point;
  if (lambda === null || naturalness === null) return [];
  return [{ id: point.id, seed: point.seed, round: point.round, lambda, naturalness, label: label(point), lines: lines(point) }];
}

/** Naturalness against λ. */
export function searchFigure(payload: Payload, chosen: Signal<string | null>): HTMLElement {
  const points = payload.points.flatMap(sweepPointOf);
  const host = h("div", { class: "chart" });
  sweepChart(host, points, chosen);
  const rounds = roundsOf(points).map((round, i) =>
    h("li", {}, h("span", { class: `swatch round-${i % 4}` }), i === 0 ? `round ${round}: even in log λ` : `round ${round}: refined`));
  return h("section", { class: "band-section" },
    h("h2", {}, "Where the search looked"),
    h("figure", {}, h("ul", { class: "legend" }, ...rounds), host,
      caption(
        "Naturalness against λ, the weight on staying natural. The first round spreads λ evenly in log space; later rounds refine where naturalness rises most. A thin line joins the humans of one seed.",
        "λ has no meaning across tasks or robots, and two humans with one λ may differ: only the frontier compares robots.",
      )));
}
