/** Where things are: poses between frames, and points that ride on a body. Pure arithmetic. */
import { restOf, type Clip, type Pose, type Quaternion, type Scene, type Vector } from "./clip.js";

function at(poses: Float32Array, offset: number): Pose {
  const v = (i: number): number => poses[offset + i] ?? 0;
  return { position: [v(0), v(1), v(2)], rotation: [v(3), v(4), v(5), v(6)] };
}

function mix(a: number, b: number, share: number): number {
  return a + (b - a) * share;
}

/**
 * The pose of the `slot`-th moving body at `time`, in frames: positions linear, rotations
 * normalised linear along the shorter way (frames are 0.1 s apart, so the error is invisible).
 */
export function poseAt(clip: Clip, slot: number, time: number): Pose {
  const clamped = Math.min(Math.max(time, 0), clip.frames - 1);
  const first = Math.floor(clamped);
  const share = clamped - first;
  const stride = 7 * clip.bodies.length;
  const a = at(clip.poses, first * stride + 7 * slot);
  if (share === 0) return normalized(a);
  const b = at(clip.poses, (first + 1) * stride + 7 * slot);
  const dot = a.rotation.reduce((sum, value, i) => sum + value * (b.rotation[i] ?? 0), 0);
  const sign = dot < 0 ? -1 : 1;
  const p = a.position.map((value, i) => mix(value, b.position[i] ?? 0, share));
  const q = a.rotation.map((value, i) => mix(value, sign * (b.rotation[i] ?? 0), share));
  return normalized({
    position: [p[0] ?? 0, p[1] ?? 0, p[2] ?? 0],
    rotation: [q[0] ?? 1, q[1] ?? 0, q[2] ?? 0, q[3] ?? 0],
  });
}

function normalized({ position, rotation }: Pose): Pose {
  const length = Math.hypot(...rotation);
  if (length === 0) return { position, rotation: [1, 0, 0, 0] };
  const [w, x, y, z] = rotation;
  return { position, rotation: [w / length, x / length, y / length, z / length] };
}

/** Rotates a vector by a unit quaternion. */
export function rotate([w, x, y, z]: Quaternion, [a, b, c]: Vector): Vector {
  // v + 2 r × (r × v + w v), r the vector part.
  const tx = 2 * (y * c - z * b);
  const ty = 2 * (z * a - x * c);
  const tz = 2 * (x * b - y * a);
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
}

/** A point fixed to a body, in the world. */
export function carry(pose: Pose, point: Vector): Vector {
  const [x, y, z] = rotate(pose.rotation, point);
  const [px, py, pz] = pose.position;
  return [px + x, py + y, pz + z];
}

/** The path of a point fixed to `body`, one position per frame; null when the body does not move. */
export function pathOf(clip: Clip, body: number, point: Vector): Vector[] | null {
  const slot = clip.bodies.indexOf(body);
  if (slot < 0) return null;
  return Array.from({ length: clip.frames }, (_, frame) => carry(poseAt(clip, slot, frame), point));
}

/** The pose of any body of the scene at `time` [frames], whether the episode moves it or not. */
export function bodyPose(scene: Scene, clip: Clip, body: number, time: number): Pose {
  const slot = clip.bodies.indexOf(body);
  return slot < 0 ? restOf(scene, body) : poseAt(clip, slot, time);
}

/** Where the tool's tip sits: the body "tool_tip", else the geom "tip" or "…_tip". */
export function tipOf(scene: Scene): { body: number; point: Vector } | null {
  const body = scene.bodies.indexOf("tool_tip");
  if (body >= 0) return { body, point: [0, 0, 0] };
  const geom = scene.geoms.find(({ name }) => /(^|_)tip$/.test(name));
  return geom ? { body: geom.body, point: geom.pos } : null;
}

/** The frame worth opening on: what went wrong, else the hardest unwanted contact, else the closest approach. */
export function tellingFrame(clip: Clip): number {
  if (clip.failure !== null) return Math.min(clip.failure.frame, clip.frames - 1);
  const best = (values: readonly number[], better: (a: number, b: number) => boolean): number =>
    values.reduce((found, value, i) => (better(value, values[found] ?? NaN) ? i : found), 0);
  const hardest = best(clip.forceUnwanted, (a, b) => a > b || Number.isNaN(b));
  if ((clip.forceUnwanted[hardest] ?? 0) > 0) return hardest;
  return best(clip.distance, (a, b) => a < b || Number.isNaN(b));
}
