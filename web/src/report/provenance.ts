/** Where the numbers come from, and how to cite them. */
import { download } from "../base/download.js";
import { button, h, type Child } from "../base/dom.js";
import { fixed } from "../base/format.js";
import { dict, number } from "../base/read.js";
import type { Payload } from "./payload.js";

const BIBTEX = `@inproceedings{he2023rigid,
  title     = {Quantifying Assistive Robustness Via the Natural-Adversarial Frontier},
  author    = {He, Jerry Zhi-Yang and Erickson, Zackory and Brown, Daniel S. and Dragan, Anca D.},
  booktitle = {Conference on Robot Learning},
  year      = {2023}
}`;

const SUMMARY: readonly (readonly [name: string, meaning: string])[] = [
  ["auc_pooled", "all seeds in one hull"],
  ["auc_staircase", "hypervolume from (0, 0)"],
  ["auc_linear", "straight lines through the frontier"],
  ["auc_excess", "above what plain sabotage gives for free"],
  ["auc_paper_axis", "pooled, linear, on each search's own discriminator: the one to hold against the paper's table"],
];

const MAX_DEPTH = 8;

/** Any JSON value as text: nested tables for objects, one line for the rest. */
function tree(value: unknown, depth = 0): Child {
  if (depth > MAX_DEPTH || value === null || typeof value !== "object") return JSON.stringify(value) ?? "";
  if (Array.isArray(value)) {
    const flat = value.every((entry) => typeof entry !== "object" || entry === null);
    return flat ? value.map((entry) => (typeof entry === "string" ? entry : JSON.stringify(entry))).join(", ") : JSON.stringify(value);
  }
  return h("dl", { class: "tree" }, ...Object.entries(value).flatMap(([name, inner]) => [
    h("dt", {}, name),
    h("dd", {}, typeof inner === "string" ? inner : tree(inner, depth + 1)),
  ]));
}

function areas(payload: Payload): HTMLElement {
  const rows = SUMMARY.filter(([name]) => number(payload.frontier[name]) !== null).map(([name, meaning]) =>
    h("tr", {}, h("th", { scope: "row" }, name), h("td", { class: "number" }, fixed(number(payload.frontier[name]))), h("td", {}, meaning)));
  const seeds = Object.entries(dict(payload.frontier["auc_by_seed"])).map(([seed, value]) =>
    h("tr", {}, h("th", { scope: "row" }, `seed ${seed}`), h("td", { class: "number" }, fixed(number(value))), h("td", {}, "hull area of this seed")));
  return h("table", { class: "areas" }, h("tbody", {}, ...rows, ...seeds));
}

/** Settings, other readings of the area, citation. */
export function provenance(payload: Payload): HTMLElement {
  const save = button("Download frontier.json", () =>
    download("frontier.json", "application/json", JSON.stringify(payload.frontier, null, 1)), { class: "quiet" });
  return h("section", { class: "band-section" },
    h("div", { class: "section-head" }, h("h2", {}, "Settings and provenance"), save),
    h("div", { class: "provenance" },
      h("details", { open: true }, h("summary", {}, "Other readings of the area"), areas(payload)),
      h("details", {}, h("summary", {}, "Settings of this run"),
        Object.keys(payload.settings).length ? tree(payload.settings) : h("p", { class: "empty" }, "No settings were stored."))),
    h("h2", {}, "How to cite"),
    h("p", { class: "prose" }, "The method is that of He, Erickson, Brown and Dragan (CoRL 2023). ",
      "State the robot, the preset, the seeds and the canonical source beside every number."),
    h("pre", { class: "bibtex", tabindex: 0, role: "region", "aria-label": "BibTeX entry" }, BIBTEX));
}
