/** One running episode in the browser: from the server's first picture to the last one shown. */
import type { Vector } from "../../replay/clip.js";
import type { Headset } from "../xr/headset.js";
import type { Way } from "./devices.js";
import type { Frame } from "./frame.js";
import type { Begun } from "./live.js";
import type { LiveView } from "./live-view.js";
import type { HandInput } from "./pointer.js";
import { reachable } from "./target.js";

const LONGEST_END = 1000; // [ms] that the last movements may take to be shown. Ours.

export interface Moment {
  /** Until the end, and in all [s]. */
  readonly left: number;
  readonly whole: number;
  readonly target: Vector;
}

export class Episode {
  #begun: Begun | null = null;
  #shown = 0;
  /** The newest step that arrived. */
  newest = 0;
  /** Whether there is something to see. */
  started = false;

  constructor(
    private readonly live: LiveView, private readonly hand: HandInput, private readonly headset: Headset | null,
    private readonly device: Exclude<Way, "vr"> | "xr-controller" | "xr-hand",
  ) {}

  begun(begun: Begun): void {
    this.#begun = begun;
    this.live.begin(begun.settings);
    const { device } = this;
    if (device !== "xr-controller" && device !== "xr-hand") this.hand.begin(device, begun.hand, begun.reach);
  }

  frame(frame: Frame): void {
    if (!this.#begun) return;
    if (this.live.take(frame, performance.now() / 1000)) {
      this.started = true;
      this.headset?.begin(this.#begun.reach); // Now it is known how the person sits.
    }
    this.newest = Math.max(this.newest, frame.step);
  }

  /** Moves on by `seconds` and shows it. */
  step(seconds: number): Moment {
    const { period, horizon } = this.#begun?.settings ?? { period: 0.1, horizon: 1 };
    this.hand.tick(seconds);
    const wanted = this.headset?.target ?? this.hand.target ?? this.live.hand;
    const target = this.#begun ? reachable(wanted, this.#begun.reach) : wanted;
    this.#shown = this.live.show(performance.now() / 1000, target);
    return { left: Math.max(0, (horizon - this.#shown) * period), whole: horizon * period, target };
  }

  /** Resolves when the last step that arrived has been shown. */
  async shownToEnd(): Promise<void> {
    const until = performance.now() + LONGEST_END;
    while (this.started && this.#shown < this.newest - 0.01 && performance.now() < until) {
      await new Promise((go) => setTimeout(go, 30));
    }
  }
}
