/** Where the hand shall go: from movements of a pointer, of keys, of a hand. Pure arithmetic. */
import type { Vector } from "../../replay/clip.js";

/** Where hand targets make sense: a ball around the shoulder. */
export interface Reach {
  readonly shoulder: Vector;
  /** [m] */
  readonly radius: number;
}

/** A camera as seen from here: unit vectors in the world, z up. */
export interface Sight {
  readonly position: Vector;
  readonly right: Vector;
  readonly up: Vector;
  readonly forward: Vector;
  /** Of view, vertical [rad]. */
  readonly angle: number;
  /** Of the picture [px]. */
  readonly height: number;
}

export function sum(a: Vector, b: Vector, scale = 1): Vector {
  return [a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale];
}

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function minus(a: Vector, b: Vector): Vector {
  return sum(a, b, -1);
}

function unit(v: Vector, otherwise: Vector): Vector {
  const length = Math.hypot(...v);
  return length < 1e-9 ? otherwise : [v[0] / length, v[1] / length, v[2] / length];
}

/** The nearest place that the arm can reach. */
export function reachable(target: Vector, { shoulder, radius }: Reach): Vector {
  const offset = minus(target, shoulder);
  const distance = Math.hypot(...offset);
  return distance <= radius ? target : sum(shoulder, offset, radius / distance);
}

/** Metres that one pixel stands for at the depth of `at`. */
export function metresPerPixel(sight: Sight, at: Vector): number {
  const depth = Math.max(0.05, dot(minus(at, sight.position), sight.forward));
  return (2 * depth * Math.tan(sight.angle / 2)) / Math.max(1, sight.height);
}

/** `at` moved by `right` and `down` [px] in the plane of the picture: it stays under the pointer. */
export function dragged(at: Vector, sight: Sight, right: number, down: number): Vector {
  const scale = metresPerPixel(sight, at);
  return sum(sum(at, sight.right, right * scale), sight.up, -down * scale);
}

/** `at` moved away from the eye by `metres`; towards it where that is negative. */
export function pushed(at: Vector, sight: Sight, metres: number): Vector {
  const away = unit(minus(at, sight.position), sight.forward);
  const depth = Math.hypot(...minus(at, sight.position));
  return sum(at, away, Math.max(metres, 0.1 - depth));
}

/** How fast a key moves the target [m/s]: across the whole reach in three seconds. Ours. */
export const KEY_SPEED = 0.45;

/** What a key does: shares of right, up, away. */
const KEYS: Readonly<Record<string, Vector>> = {
  ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0],
  PageUp: [0, 0, 1], PageDown: [0, 0, -1],
  KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyW: [0, 1, 0], KeyS: [0, -1, 0], KeyE: [0, 0, 1], KeyQ: [0, 0, -1],
};

/** Whether a key (`KeyboardEvent.code`) moves the hand. */
export function moves(code: string): boolean {
  return code in KEYS;
}

/** `at` after `seconds` of the held keys: right and away along the floor as seen, up along z. */
export function keyed(at: Vector, sight: Sight, held: Iterable<string>, seconds: number): Vector {
  let [right, up, away] = [0, 0, 0];
  for (const code of held) {
    const [r, u, a] = KEYS[code] ?? [0, 0, 0];
    [right, up, away] = [right + r, up + u, away + a];
  }
  const length = Math.hypot(right, up, away);
  if (length === 0) return at;
  const across = unit([sight.right[0], sight.right[1], 0], [1, 0, 0]);
  const ahead: Vector = [-across[1], across[0], 0];
  const step = (KEY_SPEED * seconds) / length;
  return sum(sum(sum(at, across, right * step), ahead, away * step), [0, 0, 1], up * step);
}
