/** All humans found: sortable, clickable, downloadable. */
import { download } from "../base/download.js";
import { button, caption, h, on } from "../base/dom.js";
import type { Signal } from "../base/signal.js";
import { columnsOf, csv, sorted, type Column } from "./columns.js";
import type { Payload, Point } from "./payload.js";
import { watchable } from "./words.js";

function row(point: Point, columns: readonly Column[], choose: (id: string) => void): HTMLTableRowElement {
  const [first, ...rest] = columns;
  const name = h("th", { scope: "row" }, button(first?.text(point) ?? "", () => choose(point.id), { class: "link" }));
  const cells = rest.map((column) => h("td", { class: column.numeric ? "number" : "" }, column.text(point)));
  const element = h("tr", { "data-id": point.id }, name, ...cells);
  return on(element, { click: () => choose(point.id) });
}

/** The section with the table. */
export function pointsTable(payload: Payload, chosen: Signal<string | null>, physical: boolean): HTMLElement {
  const columns = columnsOf(payload.points);
  const rows = new Map(payload.points.map((point) => [point, row(point, columns, (id) => (chosen.value = id))]));
  const body = h("tbody");
  const heads = columns.map((column) => h("th", { scope: "col", class: column.numeric ? "number" : "" }));
  let by: Column = columns.find(({ name }) => name === "naturalness") as Column;
  let descending = true;

  const refresh = (): void => {
    heads.forEach((head, i) => {
      const order = columns[i] === by ? (descending ? "descending" : "ascending") : "none";
      head.setAttribute("aria-sort", order);
    });
    body.replaceChildren(...sorted(payload.points, by, descending).flatMap((point) => rows.get(point) ?? []));
  };
  columns.forEach((column, i) => {
    heads[i]?.append(button(column.name, () => {
      descending = by === column ? !descending : column.numeric;
      by = column;
      refresh();
    }));
  });
  refresh();
  chosen.watch((id) => {
    for (const [point, element] of rows) element.classList.toggle("chosen", point.id === id);
  });
  const save = button("Download CSV", () => download("frontier-points.csv", "text/csv;charset=utf-8", csv(payload.points)), { class: "quiet" });
  return h("section", { class: "band-section" },
    h("div", { class: "section-head" }, h("h2", {}, "All humans found"), save),
    h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "All humans found" },
      h("table", { class: "points" }, h("thead", {}, h("tr", {}, ...heads)), body)),
    caption(
      "Everyone the search found, dominated ones included. The CSV holds every field that frontier.json has of them.",
      physical || !columns.some(({ name }) => name.startsWith("peak force")) ? "" : "Forces are not physical: the paper's servo caps every joint at 1 N·m.",
      `Choose a row to ${watchable(payload) ? "watch it" : "read its numbers"}, a heading to sort.`,
    ));
}
