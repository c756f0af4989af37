/**
 * Colours of λ and of search rounds. λ uses viridis, whose steps keep their order for every kind
 * of colour blindness and in grey; the ends that would vanish on the page are cut per theme.
 */
import { scaleLog } from "d3-scale";
import { interpolateViridis } from "d3-scale-chromatic";

const ON_LIGHT = [0.0, 0.84] as const;
const ON_DARK = [0.26, 1.0] as const;

/** The range of the finite, positive λ's; [1, 1] when there are none. */
export function lambdaRange(lambdas: readonly (number | null)[]): [number, number] {
  const positive = lambdas.filter((v): v is number => v !== null && v > 0 && v < Infinity);
  if (positive.length === 0) return [1, 1];
  return [Math.min(...positive), Math.max(...positive)];
}

/** λ → 0..1 in log space; 0 and ∞ take the ends, which finite λ's do not reach. */
export function lambdaShare(lambda: number | null, [low, high]: readonly [number, number]): number {
  if (lambda === null) return 0.5;
  if (lambda <= 0) return 0;
  if (lambda === Infinity) return 1;
  if (low === high) return 0.5;
  return scaleLog([low, high], [0.12, 0.88]).clamp(true)(lambda);
}

/** A style attribute's text that gives the mark its colour in both themes. */
export function lambdaStyle(share: number): string {
  const on = ([from, to]: readonly [number, number]): string =>
    interpolateViridis(from + share * (to - from));
  return `--mark: light-dark(${on(ON_LIGHT)}, ${on(ON_DARK)})`;
}

/** A CSS gradient of the λ scale. */
export function lambdaGradient(theme: "light" | "dark"): string {
  const [from, to] = theme === "light" ? ON_LIGHT : ON_DARK;
  const stops = Array.from({ length: 9 }, (_, i) => interpolateViridis(from + (i / 8) * (to - from)));
  return `linear-gradient(to right, ${stops.join(", ")})`;
}
