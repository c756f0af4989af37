/** What the headline and the first selection say, from the payload alone. */
import { dict, interval, number, numbers, text } from "../base/read.js";
import type { Payload, Point } from "./payload.js";

export interface Estimate {
  readonly value: number | null;
  readonly interval: readonly [number, number] | null;
}

/** `worst_at` at one threshold of naturalness. */
export function worstAt(payload: Payload, threshold: "0.8" | "0.9" | "0.95"): Estimate {
  return {
    value: number(dict(payload.frontier["worst_at"])[threshold]),
    interval: interval(dict(payload.frontier["worst_at_interval"])[threshold]),
  };
}

/** The largest of the seeds' `worst_at`, whose mean the headline is; null for one seed. */
export function worstOfAll(payload: Payload, threshold: "0.9"): number | null {
  const bySeed = dict(dict(payload.frontier["worst_at_by_seed"])[threshold]);
  const values = numbers(Object.values(bySeed)).filter(Number.isFinite);
  return values.length > 1 ? Math.max(...values) : null;
}

/** A scalar of frontier.json and its interval. */
export function scalar(payload: Payload, name: "auc" | "auc_natural"): Estimate {
  return {
    value: number(payload.frontier[name]),
    interval: interval(payload.frontier[`${name}_interval`]),
  };
}

/** The seeds that were searched, ascending. */
export function seedsOf(payload: Payload): number[] {
  const seeds = new Set(payload.points.flatMap((point) => point.seed ?? []));
  return [...seeds].sort((a, b) => a - b);
}

/** More faulted episodes than this share bar a point from the frontier. */
const MAX_FAULTS = 0.01;

/** Whether so many of its episodes faulted that a point counts nowhere. */
export function faultedTooOften({ faults, episodes }: Point): boolean {
  return (faults ?? 0) > MAX_FAULTS * (episodes ?? Infinity);
}

function mostAdversarial(points: readonly Point[], threshold: number): Point | null {
  let worst: Point | null = null;
  for (const point of points) {
    if (faultedTooOften(point)) continue;
    if (point.naturalness === null || point.adversarialness === null) continue;
    if (point.naturalness < threshold) continue;
    if (worst === null || point.adversarialness > (worst.adversarialness ?? -Infinity)) worst = point;
  }
  return worst;
}

/**
 * Success under the most adversarial human at naturalness ≥ `threshold`, per seed, then averaged;
 * where a seed found none, canonical play stands in, as it does for `worst_at`.
 */
export function successUnderAttack(payload: Payload, threshold: number): number | null {
  const perSeed = seedsOf(payload).map((seed) => {
    const worst = mostAdversarial(payload.points.filter((p) => p.seed === seed), threshold);
    return worst ? worst.success : payload.canonical.success;
  });
  if (perSeed.length === 0 || perSeed.some((value) => value === null)) return null;
  return perSeed.reduce<number>((sum, value) => sum + (value ?? 0), 0) / perSeed.length;
}

/**
 * The point on which the page opens: the worst natural one who is helped less often than in
 * canonical play, else one at least half as natural; where none is, the worst natural one, else the
 * most natural one.
 */
export function firstPoint(payload: Payload): Point | null {
  const usual = payload.canonical.success;
  const failed = payload.points.filter(({ success }) => success !== null && usual !== null && success < usual);
  const worst = mostAdversarial(failed, 0.8) ?? mostAdversarial(failed, 0.5) ?? mostAdversarial(payload.points, 0.8);
  if (worst) return worst;
  const natural = payload.points.filter((p) => p.naturalness !== null && p.adversarialness !== null);
  return natural.reduce<Point | null>(
    (best, p) => (best === null || (p.naturalness ?? 0) > (best.naturalness ?? 0) ? p : best),
    null,
  );
}

/**
 * Whether forces are those of a physical arm. Only the servo profile "datasheet" has real motor
 * limits; whatever else, or nothing known, counts as not physical.
 */
export function forcesArePhysical(settings: unknown): boolean {
  for (const [key, value] of Object.entries(dict(settings))) {
    if (/^(servo|servo_profile|profile)$/.test(key) && text(value) === "datasheet") return true;
    if (forcesArePhysical(value)) return true;
  }
  return false;
}

/** The level of the referee that is the x axis: the one whose values are the points' naturalness. */
export function headlineLevel(payload: Payload): string | null {
  const measured = payload.points.filter(({ naturalness }) => naturalness !== null);
  const names = measured[0]?.levels.map(([name]) => name) ?? [];
  const isAxis = (name: string): boolean =>
    measured.every(({ levels, naturalness }) => {
      const value = levels.find(([own]) => own === name)?.[1] ?? NaN;
      return Math.abs(value - (naturalness ?? NaN)) < 1e-9;
    });
  return names.find(isAxis) ?? null;
}
