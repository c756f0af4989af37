/**
 * Moving the hand with mouse, keys or fingers. Each episode belongs to one device, which is kept
 * with it; so only that device moves the hand. All of them may turn the view.
 */
import { on } from "../../base/dom.js";
import type { Vector } from "../../replay/clip.js";
import type { LiveView } from "./live-view.js";
import { dragged, keyed, metresPerPixel, moves, pushed, reachable, type Reach } from "./target.js";

export type ScreenDevice = "mouse" | "keyboard" | "touch";

/** A turn of the view for each pixel [rad]. Ours. */
const TURN_PER_PIXEL = 0.006;
/** The hand moves so far for each notch of the wheel of 100 px [m]. Ours. */
const METRES_PER_NOTCH = 0.04;
/** A turn for each press of a key or button [rad]. Ours. */
export const TURN_PER_PRESS = Math.PI / 12;

interface Held {
  x: number;
  y: number;
  /** Moves the hand rather than the view. */
  readonly moves: boolean;
}

export class HandInput {
  /** Where the hand shall go; null while no episode runs. */
  target: Vector | null = null;
  #device: ScreenDevice = "mouse";
  #reach: Reach | null = null;
  readonly #keys = new Set<string>();
  readonly #pointers = new Map<number, Held>();
  readonly #ends = new AbortController();

  constructor(private readonly live: LiveView) {
    const { canvas } = live.view;
    const { signal } = this.#ends;
    on(canvas, {
      pointerdown: (event) => this.#down(event),
      pointermove: (event) => this.#move(event),
      pointerup: (event) => this.#up(event),
      pointercancel: (event) => this.#up(event),
      contextmenu: (event) => event.preventDefault(),
    });
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { signal, passive: false });
    // Before the canvas, whose own keys turn the view of replays.
    window.addEventListener("keydown", (event) => this.#key(event), { signal, capture: true });
    window.addEventListener("keyup", ({ code }) => this.#keys.delete(code), { signal, capture: true });
    window.addEventListener("blur", () => this.#keys.clear(), { signal });
  }

  /** An episode begins: the target starts at the hand. */
  begin(device: ScreenDevice, hand: Vector, reach: Reach): void {
    this.#device = device;
    this.#reach = reach;
    this.target = hand;
    this.#keys.clear();
  }

  /** No episode runs. */
  end(): void {
    this.target = null;
    this.#keys.clear();
  }

  /** Goes on by `seconds`: held keys move the target. */
  tick(seconds: number): void {
    if (this.target && this.#keys.size > 0) this.#put(keyed(this.target, this.live.sight(), this.#keys, seconds));
  }

  dispose(): void {
    this.#ends.abort();
  }

  #put(target: Vector): void {
    this.target = this.#reach ? reachable(target, this.#reach) : target;
  }

  #down(event: PointerEvent): void {
    this.live.view.canvas.setPointerCapture(event.pointerId);
    const isTouch = event.pointerType === "touch";
    const drags = isTouch ? this.#device === "touch" : this.#device === "mouse" && event.button === 0 && !event.altKey;
    this.#pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, moves: drags });
    event.preventDefault();
    this.live.view.canvas.focus({ preventScroll: true });
  }

  #move(event: PointerEvent): void {
    const held = this.#pointers.get(event.pointerId);
    if (!held) return;
    const [right, down] = [event.clientX - held.x, event.clientY - held.y];
    const before = this.#spread();
    [held.x, held.y] = [event.clientX, event.clientY];
    if (this.#pointers.size >= 2) this.#two(right / 2, down / 2, this.#spread() - before);
    else if (!held.moves || !this.target) this.live.turn(-right * TURN_PER_PIXEL, -down * TURN_PER_PIXEL);
    else if (event.shiftKey) this.#push(-down * metresPerPixel(this.live.sight(), this.target));
    else this.#put(dragged(this.target, this.live.sight(), right, down));
  }

  #up({ pointerId }: PointerEvent): void {
    this.#pointers.delete(pointerId);
  }

  /** Two fingers: together they turn the view, apart they bring the hand closer. */
  #two(right: number, down: number, apart: number): void {
    this.live.turn(-right * TURN_PER_PIXEL, -down * TURN_PER_PIXEL);
    if (this.#device === "touch" && this.target) this.#push(-apart * metresPerPixel(this.live.sight(), this.target));
  }

  #spread(): number {
    const [a, b] = [...this.#pointers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  }

  #push(metres: number): void {
    if (this.target) this.#put(pushed(this.target, this.live.sight(), metres));
  }

  #wheel(event: WheelEvent): void {
    event.preventDefault();
    event.stopPropagation();
    const notches = (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3) || 0;
    if (this.#device === "mouse" && this.target) this.#push(-notches * METRES_PER_NOTCH);
    else this.live.turn(0, 0, 1.1 ** notches);
  }

  #key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.target) return;
    if (event.code === "Comma" || event.code === "Period") {
      this.live.turn(event.code === "Comma" ? -TURN_PER_PRESS : TURN_PER_PRESS, 0);
    } else if (moves(event.code)) {
      if (this.#device === "keyboard") this.#keys.add(event.code);
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
