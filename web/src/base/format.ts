/** Numbers as people read them. Unknown is an em dash. */

export const UNKNOWN = "—";
const MINUS = "\u2212";

/** A number with fixed decimals and a real minus sign. */
export function fixed(value: number | null | undefined, digits = 2): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return UNKNOWN;
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

/** A number of any size in at most four digits: −270, 0.025, 1.2·10⁶. */
export function general(value: number | null): string {
  if (value === null || !Number.isFinite(value)) return UNKNOWN;
  const short = Number(Math.abs(value).toPrecision(4));
  const text = short !== 0 && (short < 1e-4 || short >= 1e6) ? scientific(short) : String(short);
  return value < 0 && short !== 0 ? MINUS + text : text;
}

/** λ as printed beside a point: 0, 0.01, 1, 30, ∞. */
export function lambdaText(lambda: number | null): string {
  if (lambda === null) return UNKNOWN;
  if (lambda === Infinity) return "∞";
  if (lambda === 0) return "0";
  const text = lambda.toPrecision(3);
  return text.includes("e") ? scientific(lambda) : String(Number(text));
}

const SUPERSCRIPTS: Record<string, string> = {
  "-": "⁻", "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴",
  "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹",
};

function scientific(value: number): string {
  const [mantissa = "0", exponent = "0"] = value.toExponential(1).split("e");
  const power = [...String(Number(exponent))].map((c) => SUPERSCRIPTS[c] ?? c).join("");
  return `${String(Number(mantissa))}·10${power}`;
}

/** An interval as `[0.44, 0.60]`, or null where there is none. */
export function intervalText(interval: readonly [number, number] | null): string | null {
  return interval && `[${fixed(interval[0])}, ${fixed(interval[1])}]`;
}

/** Counts with thin groups: 31 104 000. */
export function count(value: number | null): string {
  if (value === null) return UNKNOWN;
  return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** A share as a whole percentage. */
export function percent(value: number | null): string {
  return value === null ? UNKNOWN : `${Math.round(100 * value)}\u202f%`;
}

/** Seconds as people say them: 42 s, 12 min, 1.8 h. */
export function duration(seconds: number | null): string {
  if (seconds === null) return UNKNOWN;
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}
