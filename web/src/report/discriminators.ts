/** What the discriminators of each search seed tell apart, read with care for foreign values. */
import { type Dict, dict, list, number, numbers } from "../base/read.js";
import { readClip, type Clip } from "../replay/clip.js";

/** Shares of steps that a judge tells right; an unknown one is NaN. */
export interface Accuracy {
  /** Held-out canonical motion taken for canonical, at each level of noise. */
  readonly canonical: readonly number[];
  /** Motion of each human of the seed taken for not canonical. */
  readonly adversaries: ReadonlyMap<string, number>;
}

export interface Judged {
  readonly discriminator: Accuracy;
  readonly referee: Accuracy | null;
  /** D of the canonical poses, level by level, and of the human's own; negative is canonical. */
  readonly scores: { readonly noisy: readonly (readonly number[])[]; readonly own: readonly number[] };
}

/** Poses to draw; a frame of a clip is one of them. */
export interface Poses {
  readonly levels: readonly number[];
  readonly noisy: Clip;
  readonly own: ReadonlyMap<string, Clip>;
}

export interface Discriminators {
  /** Noise in canonical standard deviations, ascending. */
  readonly levels: readonly number[];
  readonly canonicalEpisodes: number | null;
  readonly adversaryEpisodes: number | null;
  /** By point; null where the search measure has no discriminator. */
  readonly judged: ReadonlyMap<string, Judged> | null;
  readonly poses: Poses | null;
}

function readAccuracy(value: unknown, levels: number): Accuracy | null {
  const raw = dict(value);
  const canonical = numbers(raw["canonical"]);
  if (canonical.length !== levels) return null;
  const adversaries = Object.entries(dict(raw["adversaries"]));
  return { canonical, adversaries: new Map(adversaries.map(([id, share]) => [id, number(share) ?? NaN])) };
}

function readJudged(value: unknown, levels: number): Judged | null {
  const raw = dict(value);
  const discriminator = readAccuracy(raw["discriminator"], levels);
  const scores = dict(raw["scores"]);
  return discriminator && {
    discriminator,
    referee: readAccuracy(raw["referee"], levels),
    scores: { noisy: list(scores["noisy"]).map(numbers), own: numbers(scores["own"]) },
  };
}

function readPoses(value: unknown): Poses | null {
  const raw = dict(value);
  const noisy = readClip(raw["noisy"]);
  return noisy && { levels: numbers(raw["levels"]), noisy, own: readAll(raw["own"], readClip) };
}

/** The entries of a table that can be read. */
function readAll<T>(value: unknown, read: (entry: unknown) => T | null): Map<string, T> {
  return new Map(Object.entries(dict(value)).flatMap(([id, entry]) => {
    const found = read(entry);
    return found === null ? [] : [[id, found] as const];
  }));
}

function readSeed(value: unknown): Discriminators | null {
  const raw: Dict = dict(value);
  const levels = numbers(raw["levels"]);
  const ascending = levels.every((level, i) => Number.isFinite(level) && level >= 0 && (i === 0 || level > (levels[i - 1] ?? NaN)));
  if (levels.length < 2 || !ascending) return null;
  return {
    levels,
    canonicalEpisodes: number(raw["canonical_episodes"]),
    adversaryEpisodes: number(raw["adversary_episodes"]),
    judged: raw["judged"] === null ? null : readAll(raw["judged"], (entry) => readJudged(entry, levels.length)),
    poses: readPoses(raw["poses"]),
  };
}

/** By search seed; without those that were not examined, or cannot be read. */
export function readDiscriminators(value: unknown): ReadonlyMap<string, Discriminators> {
  return readAll(value, readSeed);
}
