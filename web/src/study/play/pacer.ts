/**
 * When to show what a live episode sent. Steps arrive one by one, some late; what is seen must move
 * evenly. So the page shows the past: one step behind the quickest arrival, and as much more as
 * arrivals lately differed. Pure arithmetic: the time is an argument.
 */

/** Arrivals that are remembered: 3 s at 10 Hz. Ours. */
const REMEMBERED = 30;
/** No more than this is waited for late steps [s]; what comes later is skipped to. Ours. */
const LONGEST_WAIT = 0.3;
/** How far the shown time may run ahead of or behind the clock while it catches up. Ours. */
const HASTE = 0.15;
/** From this gap [s] on it jumps instead. Ours. */
const JUMP = 0.6;

export class Pacer {
  readonly #offsets: number[] = [];
  #latest = 0;
  #shown: number | null = null;
  #last = 0;

  /** @param period Seconds between two steps. */
  constructor(private readonly period: number) {}

  /** A step came, at `now` [s]. */
  arrived(step: number, now: number): void {
    this.#offsets.push(now - step * this.period);
    if (this.#offsets.length > REMEMBERED) this.#offsets.shift();
    this.#latest = Math.max(this.#latest, step);
  }

  /** How far behind the quickest arrival the picture is, in all [s]. */
  get delay(): number {
    const wait = Math.max(...this.#offsets) - Math.min(...this.#offsets);
    return this.period + Math.min(LONGEST_WAIT, this.#offsets.length ? wait : 0);
  }

  /** The time to show at `now` [s], in steps, never beyond what is there; calls move forward. */
  at(now: number): number {
    if (this.#offsets.length === 0) return 0;
    const wanted = (now - Math.min(...this.#offsets) - this.delay) / this.period;
    const elapsed = Math.max(0, now - this.#last) / this.period;
    this.#last = now;
    if (this.#shown === null && wanted < 0) return 0; // What came first is held until its time.
    const before = this.#shown ?? wanted;
    const gap = wanted - (before + elapsed);
    const mend = Math.abs(gap) * this.period > JUMP ? gap : clamp(gap, -HASTE * elapsed, HASTE * elapsed);
    const next = this.#shown === null ? before : Math.max(before, before + elapsed + mend);
    this.#shown = clamp(next, 0, this.#latest);
    return this.#shown;
  }
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
