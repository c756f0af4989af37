/** The one time that all views of an episode share. */
import { Signal } from "../base/signal.js";

export const SPEEDS = [0.5, 1, 2] as const;

export class Clock {
  /** Now [frames], between 0 and `frames` − 1. */
  readonly time = new Signal(0);
  readonly playing = new Signal(false);
  speed: number = 1;
  #frames = 1;
  #dt = 0.1;
  #last = 0;
  #still = false;

  /** Takes the length of an episode: `frames` of `dt` seconds. It shows `time`, and plays from the beginning. */
  load(frames: number, dt: number, time: number): void {
    this.#frames = Math.max(1, frames);
    this.#dt = dt > 0 ? dt : 0.1;
    this.#still = true;
    this.time.value = Math.min(Math.max(time, 0), this.#frames - 1);
  }

  get frames(): number {
    return this.#frames;
  }

  /** Now [s]. */
  get seconds(): number {
    return this.time.value * this.#dt;
  }

  /** Goes to a moment and stays there. */
  seek(time: number): void {
    this.pause();
    this.#still = false;
    this.time.value = Math.min(Math.max(time, 0), this.#frames - 1);
  }

  toggle(): void {
    if (this.playing.value) this.pause();
    else this.play();
  }

  /** Plays on; from the beginning when at the end, or where nobody has gone to a moment yet. */
  play(): void {
    if (this.playing.value) return;
    if (this.#still || this.time.value >= this.#frames - 1) this.time.value = 0;
    this.#still = false;
    this.playing.value = true;
    this.#last = performance.now();
    requestAnimationFrame((now) => this.#tick(now));
  }

  pause(): void {
    this.playing.value = false;
  }

  #tick(now: number): void {
    if (!this.playing.value) return;
    // A tab that slept must not jump.
    const elapsed = Math.min(Math.max(0, now - this.#last), 250) / 1000;
    this.#last = now;
    const next = this.time.value + (elapsed * this.speed) / this.#dt;
    this.time.value = Math.min(next, this.#frames - 1);
    if (next >= this.#frames - 1) this.pause();
    else requestAnimationFrame((later) => this.#tick(later));
  }
}
