/** An episode that still goes on, as a clip whose frames grow: one frame a physics substep. */
import type { Clip } from "../../replay/clip.js";
import type { Frame } from "./frame.js";

export interface LiveSettings {
  readonly bodies: readonly number[];
  readonly substeps: number;
  /** Of one control step [s]. */
  readonly period: number;
  /** Control steps of the whole episode. */
  readonly horizon: number;
  readonly goal: Clip["itch"];
}

/** Grows by `take`; all else is as in a recorded clip, and empty where only the end tells. */
export class LiveClip implements Clip {
  readonly seed = NaN;
  readonly dt: number;
  readonly bodies: readonly number[];
  readonly poses: Float32Array;
  readonly itch: Clip["itch"];
  readonly forceUnwanted = [];
  readonly forceItch = [];
  readonly distance = [];
  readonly counted = [];
  readonly contacts = [];
  readonly return = null;
  readonly success = null;
  readonly outcome = "";
  readonly failure = null;
  #frames = 0;

  constructor(readonly settings: LiveSettings) {
    this.bodies = settings.bodies;
    this.dt = settings.period / settings.substeps;
    this.itch = settings.goal;
    this.poses = new Float32Array((1 + settings.horizon * settings.substeps) * this.#stride);
  }

  get #stride(): number {
    return 7 * this.bodies.length;
  }

  /** Frames that are there: one at the start, then `substeps` more each step. */
  get frames(): number {
    return this.#frames;
  }

  /** Adds what a step brought; false, and unchanged, where it does not fit this episode. */
  take(frame: Frame): boolean {
    const { substeps, horizon } = this.settings;
    const expected = frame.step === 0 ? 1 : substeps;
    if (frame.bodies !== this.bodies.length || frame.substeps !== expected || frame.step > horizon) return false;
    const first = frame.step === 0 ? 0 : (frame.step - 1) * substeps + 1;
    if (first < this.#frames) return false;
    this.#bridge(first, frame.poses.subarray(0, this.#stride));
    this.poses.set(frame.poses, first * this.#stride);
    this.#frames = first + frame.substeps;
    return true;
  }

  /** Steps that a slow connection left out: straight from the last pose to the next. */
  #bridge(until: number, next: Float32Array): void {
    const from = this.#frames;
    const last = this.poses.slice(Math.max(0, from - 1) * this.#stride, Math.max(1, from) * this.#stride);
    for (let frame = from; frame < until; frame++) {
      const share = from === 0 ? 1 : (frame - from + 1) / (until - from + 1);
      for (let i = 0; i < this.#stride; i++) {
        const a = last[i] ?? 0;
        this.poses[frame * this.#stride + i] = a + ((next[i] ?? 0) - a) * share;
      }
    }
  }
}
