/** 3D on machines of every kind: how fast pictures come, and how far to stand back for the window. */
import type { View } from "../replay/view.js";

/** Slower than so [s] for each picture, movement does not look even. Ours. */
const SLOW = 1 / 18;
/** What lies over the upper end of the picture [px]. Ours. */
const BARS = 70;
/** Over how many pictures it is judged. Ours. */
const PICTURES = 12;

/** Finds out whether pictures come too slowly. */
export class Pace {
  #times: number[] = [];

  /** Called with each picture, at `now` [s]; true once when half of the last ones took too long. */
  isSlow(now: number): boolean {
    this.#times.push(now);
    if (this.#times.length <= PICTURES) return false;
    const steps = this.#times.slice(1).map((time, i) => time - (this.#times[i] ?? time)).sort((a, b) => a - b);
    this.#times = [];
    return (steps[PICTURES / 2] ?? 0) > SLOW;
  }
}

/** Stands so far back that person and robot fit below the bar, in wide, narrow and low windows. */
export function stepBack(view: View): void {
  const { clientWidth: width, clientHeight: height } = view.canvas;
  view.step(1.22 * Math.max(0.9 + BARS / Math.max(1, height), height / Math.max(1, width)));
}
