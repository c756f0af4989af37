/** Asks a participant in the headset for their place and sizes, one sentence after the other. */
import type { Vector } from "../../replay/clip.js";
import type { StudyContext } from "../context.js";
import type { Said } from "../play/hud.js";
import { minus } from "../play/target.js";
import { ARM_LENGTHS, SEAT_HEIGHTS, shoulderOf, type Body, type Head, type Side } from "./placing.js";

/** What the measuring needs from the headset. */
export interface Measured {
  say(said: Said): void;
  head(): Head;
  /** Where a pointer's hand is in the headset's own coordinates. */
  hand(index: number): Vector | null;
  /** Which arm is played, as far as is known. */
  side(): Side;
  /** So much is known now: sits the participant there. */
  seat(head: Head, body: Body): void;
}

const UNKNOWN: Body = { seat: null, arm: null };

export class Calibration {
  #body: Body | null = null;
  #pressed: ((index: number | null) => void) | null = null;

  constructor(private readonly context: StudyContext, private readonly headset: Measured) {}

  /** Whether a press of the trigger is waited for. */
  get waits(): boolean {
    return this.#pressed !== null;
  }

  /** The trigger of a pointer was pressed; null: the session is over. */
  press(index: number | null): void {
    this.#pressed?.(index);
  }

  /** Asks for the place, and once for the sizes; false where they left meanwhile. */
  async run(): Promise<boolean> {
    const { headset, context: { words, api } } = this;
    if (!(await this.#measure("look", () => true))) return false;
    const head = headset.head();
    headset.seat(head, this.#body ?? UNKNOWN);
    if (this.#body) return true;
    const seat = await this.#measure("seat", (index) => within(headset.hand(index)?.[1], SEAT_HEIGHTS));
    if (seat === null) return false;
    const side = headset.side();
    const shoulder = shoulderOf(head, seat.value, side);
    const arm = await this.#measure("arm", (index) => within(length(headset.hand(index), shoulder), ARM_LENGTHS), {
      side: words(`vr.sides.${side}`),
    });
    if (arm === null) return false;
    this.#body = { seat: seat.value, arm: arm.value };
    headset.seat(head, this.#body);
    if (seat.value !== null && arm.value !== null) {
      await api.post("calibration", { arm_length: arm.value, seat_height: seat.value });
    }
    return true;
  }

  /** One step of the calibration; null where they left, `value` null where they skipped it. */
  async #measure<T>(
    step: string, read: (index: number) => T | null, values: Record<string, string> = {},
  ): Promise<{ readonly value: T | null } | null> {
    const { words } = this.context;
    let hint = words(`vr.${step}.hint`);
    for (;;) {
      let skipped = false;
      const skip = {
        id: "skip", label: words("vr.skip"), run: () => {
          skipped = true;
          this.#pressed?.(-1);
        },
      };
      const line = words(`vr.${step}.line`, values);
      this.headset.say({ layout: "card", heading: words("vr.heading"), line, hint, actions: step === "look" ? [] : [skip] });
      this.context.announce(`${line} ${hint}`);
      const index = await new Promise<number | null>((resolve) => (this.#pressed = resolve));
      this.#pressed = null;
      if (index === null) return null;
      if (skipped) return { value: null };
      const value = read(index);
      if (value !== null) return { value };
      hint = words("vr.once-more");
    }
  }
}

function within(value: number | null | undefined, [low, high]: readonly [number, number]): number | null {
  return value !== null && value !== undefined && value >= low && value <= high ? value : null;
}

function length(hand: Vector | null, shoulder: Vector): number | null {
  return hand && Math.hypot(...minus(hand, shoulder));
}
