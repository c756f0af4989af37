/**
 * The report's data. It may come from anyone's frontier.json, so every field is read with care
 * and what is missing is null.
 */
import { type Dict, dict, lambda, list, number, numbers, text } from "../base/read.js";
import { readScene, readClip, type Clip, type Scene } from "../replay/clip.js";
import { readDiscriminators, type Discriminators } from "./discriminators.js";
import { readFailures, type Failures } from "./failures.js";

export interface Outcomes {
  readonly helped: number;
  readonly unhelped: number;
  readonly unwanted: number;
}

/** One human policy that was measured: an adversary, or the passive reference. */
export interface Point {
  readonly id: string;
  readonly seed: number | null;
  readonly round: number | null;
  readonly lambda: number | null;
  readonly naturalness: number | null;
  readonly naturalnessOwn: number | null;
  /** The referee's verdict at every level, in the order of the file. */
  readonly levels: readonly (readonly [name: string, value: number | null])[];
  readonly adversarialness: number | null;
  readonly return: number | null;
  readonly success: number | null;
  readonly episodes: number | null;
  readonly envSteps: number | null;
  readonly outcomes: Outcomes | null;
  readonly peakForce: number | null;
  readonly impulse: number | null;
  readonly faults: number | null;
  readonly converged: boolean | null;
  readonly onFrontier: boolean;
  /** Whether another robot would have coped (`rigid blame`); null where nobody asked. */
  readonly verdict: string | null;
  readonly regret: number | null;
  readonly raw: Dict;
}

export interface Band {
  readonly x: readonly number[];
  readonly mean: readonly number[];
  readonly low: readonly number[] | null;
  readonly high: readonly number[] | null;
}

export interface Canonical {
  readonly success: number | null;
  readonly return: number | null;
  readonly adversarialness: number | null;
  readonly episodes: number | null;
  readonly source: string;
}

export interface Payload {
  readonly frontier: Dict;
  readonly task: string;
  readonly robot: string;
  readonly preset: string;
  readonly canonical: Canonical;
  readonly points: readonly Point[];
  readonly passive: Point | null;
  readonly band: Band | null;
  /** Says in which seeds canonical play stands for the headline's human; null where in none. */
  readonly lacking: string | null;
  readonly settings: Dict;
  readonly stamp: string | null;
  readonly learning: Dict;
  readonly scene: Scene | null;
  readonly replays: Replays;
  /** By search seed, those that were examined. */
  readonly discriminators: ReadonlyMap<string, Discriminators>;
  /** Null where nothing is known of how episodes failed. */
  readonly failures: Failures | null;
}

/** Decodes an episode when it is asked for: decoding all of them would delay the page. */
export interface Replays {
  readonly stored: boolean;
  point(id: string, which: "worst" | "median"): Clip | null;
  canonical(seed: number): Clip | null;
}

function readOutcomes(value: unknown): Outcomes | null {
  const { helped, unhelped, unwanted_contact } = dict(value);
  const parts = [number(helped), number(unhelped), number(unwanted_contact)];
  const [a = null, b = null, c = null] = parts;
  return a === null || b === null || c === null ? null : { helped: a, unhelped: b, unwanted: c };
}

function readPoint(value: unknown, index: number): Point {
  const raw = dict(value);
  return {
    id: text(raw["id"], `point ${index + 1}`),
    seed: number(raw["seed"]),
    round: number(raw["round"]),
    lambda: lambda(raw["lambda"]),
    naturalness: number(raw["naturalness"]),
    naturalnessOwn: number(raw["naturalness_own"]),
    levels: Object.entries(dict(raw["naturalness_all"])).map(([name, v]) => [name, number(v)] as const),
    adversarialness: number(raw["adversarialness"]),
    return: number(raw["return"]),
    success: number(raw["success"]),
    episodes: number(raw["episodes"]),
    envSteps: number(raw["env_steps"]),
    outcomes: readOutcomes(raw["outcomes"]),
    peakForce: number(raw["peak_force"]),
    impulse: number(raw["impulse"]),
    faults: number(raw["faults"]),
    converged: typeof raw["converged"] === "boolean" ? raw["converged"] : null,
    onFrontier: raw["on_frontier"] === true,
    verdict: typeof raw["verdict"] === "string" ? raw["verdict"] : null,
    regret: number(raw["regret"]),
    raw,
  };
}

function readBand(value: unknown): Band | null {
  const raw = dict(value);
  const x = numbers(raw["x"]);
  const curve = (name: string): number[] | null => {
    const values = numbers(raw[name]);
    return values.length === x.length && x.length > 1 ? values : null;
  };
  const mean = curve("mean");
  return mean && { x, mean, low: curve("low"), high: curve("high") };
}

function readCanonical(value: unknown): Canonical {
  const raw = dict(value);
  return {
    success: number(raw["success"]),
    return: number(raw["return"]),
    adversarialness: number(raw["adversarialness"]),
    episodes: number(raw["episodes"]),
    source: text(raw["source"], "unknown source"),
  };
}

/** Looks up replays by name without ever touching a prototype. */
function own(source: Dict, key: string): unknown {
  return Object.hasOwn(source, key) ? source[key] : undefined;
}

function readReplays(value: unknown): Replays {
  const all = dict(value);
  return {
    stored: Object.keys(all).length > 0,
    point: (id, which) => {
      const entry = dict(own(all, id));
      return readClip("poses" in entry ? (which === "worst" ? entry : null) : own(entry, which));
    },
    canonical: (seed) => readClip(own(dict(own(all, "canonical")), String(seed))),
  };
}

/** Reads the payload that the page carries. */
export function readPayload(value: unknown): Payload {
  const raw = dict(value);
  const frontier = dict(raw["frontier"]);
  const passive = raw["passive"] == null ? null : dict(raw["passive"]);
  return {
    frontier,
    task: text(frontier["task"], "unknown task"),
    robot: text(frontier["robot"], "unknown robot"),
    preset: text(frontier["preset"], "unknown"),
    canonical: readCanonical(frontier["canonical"]),
    points: list(frontier["points"]).map(readPoint),
    passive: passive && readPoint({ ...passive, id: "passive", lambda: null, on_frontier: false }, 0),
    band: readBand(raw["band"]),
    lacking: text(raw["lacking"]) || null,
    settings: dict(raw["settings"]),
    stamp: typeof raw["stamp"] === "string" ? raw["stamp"] : null,
    learning: dict(raw["learning"]),
    scene: readScene(raw["scene"]),
    replays: readReplays(raw["replays"]),
    discriminators: readDiscriminators(raw["discriminators"]),
    failures: readFailures(raw["failures"]),
  };
}
