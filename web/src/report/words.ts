/** How points are named in tooltips, labels and captions. */
import { fixed, lambdaText, percent } from "../base/format.js";
import { headlineLevel } from "./measures.js";
import { dict, text, type Dict } from "../base/read.js";
import type { Payload, Point } from "./payload.js";

const NAMES: Record<string, string> = {
  helped: "helped",
  unhelped: "unhelped",
  unwanted_contact: "unwanted contact",
};

/** "s0-r1-l3" with its λ; the passive reference by its name. */
export function title(point: Point): string {
  return isPassive(point) ? "passive human" : `${point.id} · λ ${lambdaText(point.lambda)}`;
}

/** The reference human who does nothing: shown, never counted as an attack. */
export function isPassive(point: Point): boolean {
  return point.id === "passive" && point.lambda === null;
}

/** Lines of a tooltip. */
export function lines(point: Point): string[] {
  return [
    title(point),
    `naturalness ${fixed(point.naturalness)}`,
    `adversarialness ${fixed(point.adversarialness)}`,
    `success ${percent(point.success)}`,
    ...(isPassive(point) ? ["an untrained human who does nothing: a reference, not an attack"] : []),
  ];
}

/** What a screen reader says of a point. */
export function label(point: Point): string {
  const place = isPassive(point) ? "reference" : point.onFrontier ? "not dominated" : "dominated";
  return `${lines(point).slice(0, 4).join(", ")}, ${place}`;
}

/** Whether there is motion to watch: the task has a picture, and episodes were stored. */
export function watchable(payload: Payload): boolean {
  return payload.replays.stored && payload.scene !== null;
}

/** An episode's outcome as people say it. */
export function outcomeText(outcome: string): string {
  return NAMES[outcome] ?? outcome;
}

/** "step_k4" → "single steps, κ = 4"; names of another form stay as they are. */
export function levelText(name: string): string {
  const match = /^(step|window(\d+))_k(\d+)$/.exec(name);
  if (!match) return name;
  const span = match[2] ? `${match[2]}-step windows` : "single steps";
  return `${span}, κ = ${match[3] ?? ""}`;
}

/** Where the range of adversarialness comes from: `range_source` of frontier.json. */
export function rangeSource(frontier: Dict): string {
  const source = text(frontier["range_source"]);
  const file = dict(frontier["range_file"]);
  if (source === "task") return "the task's range";
  if (source === "option") return "a range given by the user";
  if (source !== "calibrated") return `range: ${source || "source unknown"}`;
  return `calibrated range, ${text(file["name"], "unknown file")} ${text(file["sha256"]).slice(0, 8)}`.trim();
}

/** What the axis lets pass: said wherever naturalness is shown. */
export function axisSentence(payload: Payload): string {
  const level = headlineLevel(payload);
  if (level === null) return "";
  const sentence = `The referee judges ${levelText(level).replace(", ", " at ")}`;
  return level === "step_k4"
    ? `${sentence}: replaying the worst quarter of canonical behaviour still counts as natural.`
    : `${sentence}.`;
}
