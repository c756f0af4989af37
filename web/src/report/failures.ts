/** How the robot fails, by kind, read with care for foreign values. */
import { dict, interval, list, number, text } from "../base/read.js";
import type { Which } from "./transport.js";

/** The most natural episode that shows a mode. */
export interface FailureExample {
  readonly id: string;
  readonly which: Which;
  readonly naturalness: number | null;
  readonly frame: number;
  /** Seconds into the episode. */
  readonly time: number | null;
  readonly says: string;
}

export interface FailureMode {
  /** Whether the robot touched the person where nothing should. */
  readonly unwanted: boolean;
  readonly title: string;
  readonly meaning: string;
  readonly ids: readonly string[];
  readonly naturalness: readonly [low: number, high: number] | null;
  /** Of all episodes, an estimate. */
  readonly share: number | null;
  readonly example: FailureExample;
}

export interface Failures {
  readonly humans: number | null;
  readonly modes: readonly FailureMode[];
  /** Share of episodes that failed in ways that no stored episode shows. */
  readonly unseen: number | null;
}

function readExample(value: unknown): FailureExample | null {
  const raw = dict(value);
  const frame = number(raw["frame"]);
  if (typeof raw["id"] !== "string" || frame === null) return null;
  return {
    id: raw["id"],
    which: raw["episode"] === "median" ? "median" : "worst",
    naturalness: number(raw["naturalness"]),
    frame,
    time: number(raw["time"]),
    says: text(raw["says"]),
  };
}

function readMode(value: unknown): FailureMode[] {
  const raw = dict(value);
  const example = readExample(raw["example"]);
  return example === null ? [] : [{
    unwanted: raw["kind"] === "unwanted_contact",
    title: text(raw["title"], text(raw["kind"], "unnamed")),
    meaning: text(raw["meaning"]),
    ids: list(raw["points"]).flatMap((id) => (typeof id === "string" ? [id] : [])),
    naturalness: interval(raw["naturalness"]),
    share: number(raw["share"]),
    example,
  }];
}

/** The modes, in the order of the file; null where nothing is known of how episodes failed. */
export function readFailures(value: unknown): Failures | null {
  const raw = dict(value);
  if (!Array.isArray(raw["modes"])) return null;
  return { humans: number(raw["humans"]), modes: raw["modes"].flatMap(readMode), unseen: number(raw["unseen"]) };
}
