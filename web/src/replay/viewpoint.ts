/** Where to look from, so that robot, person and the point of contact are all seen. */
import { Box3, MathUtils, Vector3 } from "three";
import type { Clip, Scene } from "./clip.js";
import { bodyPose, carry, pathOf, tipOf } from "./pose.js";

export interface Viewpoint {
  readonly position: Vector3;
  readonly target: Vector3;
}

export const FIELD_OF_VIEW = 32;
const ELEVATION = MathUtils.degToRad(24);
/** Turned from square-on, so that depth is read [rad]. */
const TURN = MathUtils.degToRad(24);
/** From the middle of a head to above its top [m]; people look for faces first. */
const HEAD = 0.16;

/** Centres of the geoms of a role at some moments [share of the episode]. */
export function centersOf(scene: Scene, clip: Clip, role: string, shares: readonly number[]): Vector3[] {
  const moments = shares.map((share) => Math.round(share * (clip.frames - 1)));
  return scene.geoms
    .filter((geom) => geom.role === role)
    .flatMap((geom) => moments.map((time) => carry(bodyPose(scene, clip, geom.body, time), geom.pos)))
    .map((at) => new Vector3(...at));
}

function mean(points: readonly Vector3[]): Vector3 {
  const sum = points.reduce((total, p) => total.add(p), new Vector3());
  return points.length ? sum.divideScalar(points.length) : sum;
}

/** Where the person faces, horizontally: a seated person's legs are before the trunk. */
export function facing(human: readonly Vector3[]): Vector3 {
  const byHeight = [...human].sort((a, b) => a.z - b.z);
  const half = Math.floor(byHeight.length / 2);
  return mean(byHeight.slice(0, half)).sub(mean(byHeight.slice(half))).setZ(0);
}

/** The places that matter: where the tool and the itch are during the episode. */
function action(scene: Scene, clip: Clip): Vector3[] {
  const tip = tipOf(scene);
  const paths = [
    tip && pathOf(clip, tip.body, tip.point),
    clip.itch && pathOf(clip, clip.itch.body, clip.itch.pos),
  ];
  return paths.flatMap((path) => path ?? []).map((at) => new Vector3(...at));
}

/** By how much a point, relative to the target, is above the picture's top. */
function above(point: Vector3, direction: Vector3, distance: number): number {
  const top = Math.tan(MathUtils.degToRad(FIELD_OF_VIEW / 2)) * (distance - point.dot(direction));
  return point.dot(upOf(direction)) - top;
}

function upOf(direction: Vector3): Vector3 {
  return new Vector3(0, 0, 1).addScaledVector(direction, -direction.z).normalize();
}

/**
 * A viewpoint beside the line from person to robot, on the side that the person faces, a little
 * from above, far enough for the whole robot and the person's upper body.
 */
export function viewpointFor(scene: Scene, clip: Clip): Viewpoint {
  const human = centersOf(scene, clip, "human", [0]);
  const start = centersOf(scene, clip, "robot", [0]);
  const robot = centersOf(scene, clip, "robot", [0, 1 / 3, 2 / 3, 1]);
  const contact = action(scene, clip);
  const focus = contact.length ? mean(contact) : mean([...human, ...robot]);
  const across = mean(start).sub(mean(human)).setZ(0);
  if (across.lengthSq() < 1e-6) across.set(1, 0, 0);
  across.normalize();
  const side = new Vector3(-across.y, across.x, 0);
  if (side.dot(facing(human)) < 0) side.negate();
  side.addScaledVector(across, Math.tan(TURN)).normalize();

  const upper = human.filter(({ z }) => z > focus.z - 0.15);
  const box = new Box3().setFromPoints([...robot, ...upper, ...contact]);
  const target = box.getCenter(new Vector3()).lerp(focus, 0.45);
  const radius = 0.5 * box.getSize(new Vector3()).length() * 0.8;
  const direction = side.multiplyScalar(Math.cos(ELEVATION)).setZ(Math.sin(ELEVATION));
  const tops = upper.map(({ x, y, z }) => new Vector3(x, y, z + HEAD).sub(target));
  const distance = radius / Math.sin(MathUtils.degToRad(FIELD_OF_VIEW / 2));
  // Moving away instead would make everything smaller.
  const beyond = Math.max(0, ...tops.map((top) => above(top, direction, distance)));
  target.addScaledVector(upOf(direction), beyond);
  return { target, position: target.clone().addScaledVector(direction, distance) };
}
