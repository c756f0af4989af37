/** The table of all humans as data: columns, order, CSV. */
import { fixed, lambdaText, percent, UNKNOWN } from "../base/format.js";
import type { Point } from "./payload.js";

export interface Column {
  readonly name: string;
  /** What the column sorts by. */
  readonly key: (point: Point) => number | string | null;
  readonly text: (point: Point) => string;
  readonly numeric: boolean;
}

function numeric(name: string, key: (p: Point) => number | null, text: (v: number | null) => string): Column {
  return { name, key, text: (p) => text(key(p)), numeric: true };
}

const yes = (value: boolean | null): string => (value === null ? UNKNOWN : value ? "yes" : "no");

export const COLUMNS: readonly Column[] = [
  { name: "human", key: (p) => p.id, text: (p) => p.id, numeric: false },
  numeric("λ", (p) => p.lambda, lambdaText),
  numeric("seed", (p) => p.seed, (v) => fixed(v, 0)),
  numeric("round", (p) => p.round, (v) => fixed(v, 0)),
  numeric("naturalness", (p) => p.naturalness, fixed),
  numeric("adversarialness", (p) => p.adversarialness, fixed),
  numeric("return", (p) => p.return, (v) => fixed(v, 1)),
  numeric("success", (p) => p.success, percent),
  numeric("unwanted", (p) => p.outcomes?.unwanted ?? null, percent),
  numeric("peak force [N]", (p) => p.peakForce, (v) => fixed(v, 1)),
  numeric("impulse [N·s]", (p) => p.impulse, (v) => fixed(v, 1)),
  numeric("regret", (p) => p.regret, fixed),
  numeric("faults", (p) => p.faults, (v) => fixed(v, 0)),
  { name: "at rest", key: (p) => (p.converged === null ? null : Number(p.converged)), text: (p) => yes(p.converged), numeric: false },
  { name: "frontier", key: (p) => Number(p.onFrontier), text: (p) => yes(p.onFrontier), numeric: false },
];

/** Columns of what not every task or run knows. */
const OPTIONAL = new Set(["success", "unwanted", "peak force [N]", "impulse [N·s]", "regret"]);

/** The columns to show: what is known of nobody, such as forces in a task without any, has none. */
export function columnsOf(points: readonly Point[]): readonly Column[] {
  return COLUMNS.filter((column) =>
    !OPTIONAL.has(column.name) || points.some((point) => column.key(point) !== null));
}

/** Points in the order of a column; unknown values come last either way, ties keep their order. */
export function sorted(points: readonly Point[], column: Column, descending: boolean): Point[] {
  const sign = descending ? -1 : 1;
  return [...points].sort((p, q) => {
    const [a, b] = [column.key(p), column.key(q)];
    if (a === null || b === null) return Number(a === null) - Number(b === null);
    if (typeof a === "string" || typeof b === "string") {
      return sign * String(a).localeCompare(String(b), "en", { numeric: true });
    }
    return a === b ? 0 : sign * (a < b ? -1 : 1);
  });
}

function flatten(value: unknown, name: string, into: Map<string, unknown>): void {
  if (typeof value === "object" && value !== null && !Array.isArray(value)) {
    for (const [key, inner] of Object.entries(value)) flatten(inner, name ? `${name}.${key}` : key, into);
  } else into.set(name, value);
}

function cell(value: unknown): string {
  if (value === null || value === undefined) return "";
  if (typeof value === "number" || typeof value === "boolean") return String(value);
  const text = typeof value === "string" ? value : JSON.stringify(value);
  // A spreadsheet would run a foreign text that starts like a formula.
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

/** Every field of every point as in frontier.json, nested names joined by dots. */
export function csv(points: readonly Point[]): string {
  const rows = points.map(({ raw }) => {
    const row = new Map<string, unknown>();
    flatten(raw, "", row);
    return row;
  });
  const names = [...new Set(rows.flatMap((row) => [...row.keys()]))];
  const table = [names.map(cell), ...rows.map((row) => names.map((name) => cell(row.get(name))))];
  return table.map((row) => row.join(",")).join("\r\n") + "\r\n";
}
