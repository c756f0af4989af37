/**
 * Puts a participant into the seated person's place: their shoulder on the person's shoulder, their
 * stretched arm as long as the person can reach, facing the same way. So the hand that they see is
 * where their hand is. Pure arithmetic. Headset coordinates have y up and look along −z [m].
 */
import type { Vector } from "../../replay/clip.js";
import { minus, sum, type Reach } from "../play/target.js";

/**
 * How much of the eyes' height over the seat the shoulder has: sitting acromial height over sitting
 * eye height, 59.8 of 79.2 cm in men, 55.6 of 73.9 cm in women (Gordon et al. 1989, ANSUR).
 */
const SHOULDER_SHARE = 0.755;
/** Eyes over the seat where it was not measured [m]: the mean of both, Gordon et al. 1989. */
const SITTING_EYES = 0.765;
/** From the middle to the shoulder [m]: half the biacromial breadth, 39.7 and 36.3 cm (same). */
const SHOULDER_OUT = 0.19;
/** From the eyes back to the shoulders [m]. Ours. */
const SHOULDER_BACK = 0.09;
/** Bounds of what a calibration may say [m]; beyond them somebody misunderstood. Ours. */
export const ARM_LENGTHS = [0.35, 1.1] as const;
export const SEAT_HEIGHTS = [0.2, 0.9] as const;

/** Where a head is, in headset coordinates. */
export interface Head {
  readonly position: Vector;
  readonly forward: Vector;
}

/** Sizes of a participant [m]; null where they were not measured. */
export interface Body {
  /** Of the seat, over the floor. */
  readonly seat: number | null;
  /** Of the stretched arm, shoulder to hand. */
  readonly arm: number | null;
}

/** Which arm is played. */
export type Side = "left" | "right";

/** How headset coordinates lie in the world: scaled, stood upright, turned about z, moved. */
export interface Placement {
  readonly scale: number;
  readonly yaw: number;
  readonly position: Vector;
}

function level([x, , z]: Vector): Vector {
  const length = Math.hypot(x, z);
  return length < 1e-6 ? [0, 0, -1] : [x / length, 0, z / length];
}

/** The shoulder of the played arm, from the head and the seat's height (null: not measured). */
export function shoulderOf({ position, forward }: Head, seat: number | null, side: Side): Vector {
  const ahead = level(forward);
  const right: Vector = [-ahead[2], 0, ahead[0]];
  const eyes = seat === null ? SITTING_EYES : Math.max(0, position[1] - seat);
  const drop: Vector = [0, -(1 - SHOULDER_SHARE) * eyes, 0];
  const out = side === "right" ? SHOULDER_OUT : -SHOULDER_OUT;
  return sum(sum(sum(position, drop), right, out), ahead, -SHOULDER_BACK);
}

/** From headset to world axes, before the turn. */
function upright([x, y, z]: Vector): Vector {
  return [x, -z, y];
}

function turned([x, y, z]: Vector, yaw: number): Vector {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return [c * x - s * y, s * x + c * y, z];
}

/** Where a point of the headset's coordinates lies in the world. */
export function placed({ scale, yaw, position }: Placement, at: Vector): Vector {
  return sum(position, turned(upright(at), yaw), scale);
}

/**
 * The placement of a participant.
 *
 * @param facing Where the seated person looks, horizontally, in the world.
 * @param arm Length of the stretched arm, shoulder to hand [m]; null where it was not measured.
 */
export function placementFor(
  head: Head, shoulder: Vector, arm: number | null, reach: Reach, facing: Vector,
): Placement {
  const [x, y] = upright(level(head.forward));
  const yaw = Math.atan2(facing[1], facing[0]) - Math.atan2(y, x);
  const scale = arm === null ? 1 : reach.radius / arm;
  const position = sum(reach.shoulder, turned(upright(shoulder), yaw), -scale);
  return { scale, yaw, position };
}

/** On which side of somebody who looks along `facing` a shoulder is. */
export function sideOf(shoulder: Vector, middle: Vector, facing: Vector): Side {
  const [x, y] = minus(shoulder, middle);
  return x * facing[1] - y * facing[0] >= 0 ? "right" : "left";
}
