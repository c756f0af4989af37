/** Who was measured, with what, and the four numbers that matter. */
import { h, type Child } from "../base/dom.js";
import { count, duration, fixed, intervalText, UNKNOWN } from "../base/format.js";
import { number } from "../base/read.js";
import { themeSwitch } from "../base/theme.js";
import { scalar, seedsOf, successUnderAttack, worstAt, worstOfAll, type Estimate } from "./measures.js";
import type { Payload } from "./payload.js";

function fact(name: string, value: string): HTMLElement {
  return h("div", {}, h("dt", {}, name), h("dd", {}, value));
}

function canonicalText({ canonical }: Payload): string {
  return canonical.episodes === null
    ? canonical.source
    : `${canonical.source}, n = ${count(canonical.episodes)}`;
}

/** The page's head: wordmark, task, robot, conditions, stamp. */
export function masthead(payload: Payload): HTMLElement {
  const seeds = seedsOf(payload).length;
  const cost = number(payload.frontier["wall_seconds"]);
  return h("header", { class: "masthead" },
    h("div", { class: "masthead-row" },
      h("span", { class: "wordmark" }, "RIGID"),
      h("span", { class: "wordmark-note" }, "natural-adversarial frontier"),
      payload.stamp !== null && h("strong", { class: "stamp" }, payload.stamp),
      themeSwitch()),
    h("h1", {}, payload.robot, h("span", { class: "on-task" }, ` on ${payload.task}`)),
    h("dl", { class: "facts" },
      fact("preset", payload.preset),
      fact("search", seeds === 1 ? "1 seed" : `${seeds} seeds`),
      fact("humans found", String(payload.points.length)),
      fact("canonical play", canonicalText(payload)),
      fact("training steps", count(number(payload.frontier["env_steps"]))),
      cost !== null && fact("time", duration(cost))));
}

/** A rail from 0 to 1 with the interval on it: how sure we are, at a glance. */
function rail({ value, interval }: Estimate): HTMLElement {
  const at = (v: number): string => `${(100 * Math.min(Math.max(v, 0), 1)).toFixed(2)}%`;
  const [low, high] = interval ?? [0, 0];
  return h("span", { class: "rail", "aria-hidden": "true" },
    interval && h("span", { class: "rail-span", style: `left: ${at(low)}; width: ${at(high - low)}` }),
    value !== null && h("span", { class: "rail-tick", style: `left: ${at(value)}` }));
}

function headline(id: string, name: string, estimate: Estimate, seeds: number, ...notes: Child[]): HTMLElement {
  const missing = seeds === 1 ? "one seed: no interval" : "no interval";
  const range = estimate.value === null ? "not measured" : (intervalText(estimate.interval) ?? missing);
  return h("div", { class: "headline", id },
    h("h2", {}, name),
    h("p", { class: "figure-value" }, fixed(estimate.value)),
    rail(estimate),
    h("p", { class: "interval" }, range),
    ...notes);
}

function note(...said: Child[]): HTMLElement {
  return h("p", { class: "note" }, ...said);
}

/** What the first number is: a mean, of whom, and the largest that went into it. */
function worst(payload: Payload, seeds: number): HTMLElement {
  const most = worstOfAll(payload, "0.9");
  const others = `≥ 0.8: ${fixed(worstAt(payload, "0.8").value)} · ≥ 0.95: ${fixed(worstAt(payload, "0.95").value)}`;
  return headline("worst", "Worst at naturalness ≥ 0.9", worstAt(payload, "0.9"), seeds,
    payload.lacking !== null && h("p", { class: "lacking" }, payload.lacking),
    most !== null && note("mean over seeds of each seed's worst; ", h("strong", {}, `the worst of all: ${fixed(most)}`)),
    note(others));
}

/** The four numbers, in the order in which they should be read. */
export function headlines(payload: Payload): HTMLElement {
  const seeds = seedsOf(payload).length;
  return h("section", { class: "headlines", "aria-label": "Headline numbers" },
    worst(payload, seeds),
    headline("auc-natural", "Mean over [0.8, 1]", scalar(payload, "auc_natural"), seeds, note("height of the frontier, which mixes humans")),
    headline("auc", "AUC", scalar(payload, "auc"), seeds, note("lower is more robust")),
    success(payload),
    h("p", { class: "honesty" },
      seeds > 1 && "Means over search seeds, with 95 % intervals. ",
      "Each number is an estimate at the stated search power; it bounds nothing. ",
      "A weak referee errs upward, a weak search downward."));
}

function success(payload: Payload): HTMLElement {
  const from = payload.canonical.success;
  const to = successUnderAttack(payload, 0.9);
  return h("div", { class: "headline", id: "success" },
    h("h2", {}, "Success"),
    h("p", { class: "figure-value" }, fixed(from),
      h("span", { class: "arrow", "aria-label": "falls to" }, " → "), to === null ? UNKNOWN : fixed(to)),
    h("span", { class: "rail", "aria-hidden": "true" },
      from !== null && h("span", { class: "rail-tick faint", style: `left: ${100 * from}%` }),
      to !== null && h("span", { class: "rail-tick", style: `left: ${100 * to}%` })),
    h("p", { class: "interval" }, "canonical → worst at ≥ 0.9"),
    note(from === null && to === null ? "this task tells no success"
      : payload.lacking === null ? "mean over seeds"
      : "mean over seeds, canonical play where a seed found nobody"));
}
