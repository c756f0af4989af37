/** Assembles the report from the JSON that the page carries. */
import "../styles/report.css";
import { h } from "../base/dom.js";
import { Signal } from "../base/signal.js";
import { details } from "./details.js";
import { failureModes } from "./failure-modes.js";
import { frontierFigure } from "./frontier-figure.js";
import { learning } from "./learning.js";
import { headlines, masthead } from "./masthead.js";
import { firstPoint, forcesArePhysical } from "./measures.js";
import { endings, searchFigure } from "./overview.js";
import { readPayload, type Payload, type Point } from "./payload.js";
import { provenance } from "./provenance.js";
import { replayPanel, type Moment } from "./replay-panel.js";
import { pointsTable } from "./table.js";
import { watchable } from "./words.js";

/** The chosen id, kept in the address so that a link can point at a failure. */
function selection(payload: Payload): { readonly id: Signal<string | null>; readonly point: Signal<Point | null> } {
  const all = payload.passive ? [...payload.points, payload.passive] : payload.points;
  const byId = new Map(all.map((point) => [point.id, point]));
  const linked = new URLSearchParams(location.hash.slice(1)).get("human");
  const first = (linked !== null && byId.get(linked)) || firstPoint(payload);
  const id = new Signal<string | null>(first?.id ?? null);
  const point = new Signal<Point | null>(first);
  id.watch((next) => {
    if (next === null || next === point.value?.id) return;
    point.value = byId.get(next) ?? null;
    history.replaceState(null, "", `#${new URLSearchParams({ human: next }).toString()}`);
  });
  return { id, point };
}

/** On paper, everything that can be folded is open. */
function unfoldOnPaper(): void {
  matchMedia("print").addEventListener("change", ({ matches }) => {
    if (!matches) return;
    for (const fold of document.querySelectorAll("details")) fold.open = true;
  });
}

function page(payload: Payload): HTMLElement {
  const { id, point } = selection(payload);
  const physical = forcesArePhysical(payload.settings);
  const moment = new Signal<Moment | null>(null);
  const motion = replayPanel(payload, point, physical, moment);
  const chosen = details(payload, point, physical);
  const moving = watchable(payload);
  return h("div", { class: "page" },
    masthead(payload),
    h("main", {},
      headlines(payload),
      h("div", { class: "stage" },
        frontierFigure(payload, id),
        // Without motion its place is the numbers', beside the chart.
        moving ? motion : h("div", { class: "numbers-alone" }, chosen, motion)),
      moving && chosen,
      failureModes(payload, id, physical, (example) => {
        id.value = example.id;
        moment.value = { which: example.which, frame: example.frame };
      }),
      learning(payload, point, (next) => (id.value = next)),
      h("div", { class: "pair" }, endings(payload, id), searchFigure(payload, id)),
      pointsTable(payload, id, physical),
      provenance(payload)));
}

function start(): void {
  const data = document.getElementById("rigid-payload")?.textContent ?? "null";
  const payload = readPayload(JSON.parse(data));
  document.title = `${payload.robot} on ${payload.task} · RIGID`;
  document.body.replaceChildren(page(payload));
  unfoldOnPaper();
}

start();
