/** How the robot fails, grouped by kind: the modes, and the most natural human who shows each. */
import { button, caption, h } from "../base/dom.js";
import { fixed, percent } from "../base/format.js";
import type { Signal } from "../base/signal.js";
import { rug, type RugMark } from "../chart/rug.js";
import type { FailureExample, FailureMode, Failures } from "./failures.js";
import type { Payload } from "./payload.js";

/** The section; `watch` opens the replay of an example at its moment. */
export function failureModes(
  payload: Payload, chosen: Signal<string | null>, physical: boolean, watch: (example: FailureExample) => void,
): HTMLElement {
  const { failures } = payload;
  return h("section", { class: "band-section failure-modes" },
    h("h2", {}, "Failure modes"),
    failures === null || failures.modes.length === 0
      ? h("p", { class: "empty" }, nothing(failures))
      : h("figure", {}, h("ol", { class: "modes" }, ...failures.modes.map((mode) => row(payload, failures, mode, chosen, watch))),
        caption(
          "What went wrong in the worst and in the median episode of every human found, by kind, the kind of the most natural human first. Lines on the strip are the humans who show it, the one with a head is the most natural; dots are all others.",
          doesNot(failures, physical),
          "Watch opens the replay at the moment that tells.",
        )));
}

function nothing(failures: Failures | null): string {
  if (failures === null) return "How episodes failed is unknown: this task, or this run, does not tell.";
  const others = (failures.unseen ?? 0) > 0
    ? ` Of all their episodes ${few(failures.unseen)} failed in ways that neither shows.` : "";
  return `None: the worst and the median episode of every human found were helped.${others}`;
}

function doesNot({ unseen }: Failures, physical: boolean): string {
  const others = (unseen ?? 0) > 0 ? `; ${few(unseen)} of all episodes failed in ways that neither shows` : "";
  return `Two episodes of each human are looked at, so a share is an estimate from how all its episodes ended${others}. An episode has one kind, by the first of a few rules that holds, whose limits are RIGID's own: unwanted contact outranks all else.${physical ? "" : " Forces are not physical: the paper's servo caps every joint at 1 N·m."}`;
}

/** A share that is small, but not nothing. */
function few(share: number | null): string {
  return share !== null && share > 0 && share < 0.005 ? "less than 1\u202f%" : percent(share);
}

function row(
  payload: Payload, { humans }: Failures, mode: FailureMode, chosen: Signal<string | null>, watch: (example: FailureExample) => void,
): HTMLElement {
  const count = `${mode.ids.length} of ${humans ?? payload.points.length} humans`;
  const range = rangeText(mode.naturalness);
  return h("li", { class: "mode" },
    h("div", { class: "mode-name" },
      h("h3", {}, h("span", { class: `swatch ${mode.unwanted ? "unwanted" : "unhelped"}`, "aria-hidden": "true" }), mode.title),
      h("p", { class: "note" }, mode.meaning)),
    h("div", { class: "mode-humans" },
      h("p", {}, h("b", {}, count), `, naturalness ${range}`),
      rug(`${count}, naturalness ${range}`, ...marks(payload, mode), mode.example.id, chosen),
      h("p", { class: "note" }, `about ${few(mode.share)} of all episodes`)),
    exampleOf(mode, watch));
}

function rangeText(range: FailureMode["naturalness"]): string {
  const [low, high] = (range ?? [null, null]).map((value) => fixed(value));
  return low === high ? `${low}` : `${low} to ${high}`;
}

/** Humans who show the mode, and all others. */
function marks(payload: Payload, { ids }: FailureMode): [members: RugMark[], others: RugMark[]] {
  const members = new Set(ids);
  const all = payload.points.flatMap(({ id, naturalness }): RugMark[] => (naturalness === null ? [] : [{ id, naturalness }]));
  return [all.filter(({ id }) => members.has(id)), all.filter(({ id }) => !members.has(id))];
}

function exampleOf({ title, example }: FailureMode, watch: (example: FailureExample) => void): HTMLElement {
  const moment = `${fixed(example.time, 1)} s`;
  const open = button(`Watch at ${moment}`, () => watch(example), { "aria-label": `Watch at ${moment}: ${title}, ${example.id}` });
  return h("div", { class: "mode-example" },
    h("p", {}, `${example.id}, ${example.which} episode, naturalness ${fixed(example.naturalness)}, at ${moment}`),
    h("p", { class: "mode-says" }, example.says),
    open);
}
