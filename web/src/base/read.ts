/** Reads values of unknown origin. Whatever has the wrong type counts as unknown: null. */

export type Dict = Readonly<Record<string, unknown>>;

export function number(value: unknown): number | null {
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

export function text(value: unknown, otherwise = ""): string {
  if (typeof value === "string") return value;
  return typeof value === "number" || typeof value === "boolean" ? String(value) : otherwise;
}

export function dict(value: unknown): Dict {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Dict) : {};
}

export function list(value: unknown): readonly unknown[] {
  return Array.isArray(value) ? value : [];
}

/** An array of numbers; an unknown entry becomes NaN, so that positions stay. */
export function numbers(value: unknown): number[] {
  return list(value).map((entry) => number(entry) ?? NaN);
}

/** Two finite numbers, else null. */
export function interval(value: unknown): [number, number] | null {
  const [low, high] = numbers(value);
  return low !== undefined && high !== undefined && Number.isFinite(low + high) ? [low, high] : null;
}

/** λ of frontier.json: a number, or the string "inf". */
export function lambda(value: unknown): number | null {
  return value === "inf" ? Infinity : number(value);
}
