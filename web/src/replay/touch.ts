/** Which geom a contact point belongs to: the recording stores points, people see limbs. */
import type { Clip, Contact, Geom, Pose, Quaternion, Scene, Vector } from "./clip.js";
import { bodyPose, rotate } from "./pose.js";

function inverse([w, x, y, z]: Quaternion): Quaternion {
  return [w, -x, -y, -z];
}

function minus(a: Vector, b: Vector): Vector {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

/**
 * Distance [m] from a point to a geom's surface, both in the geom's frame; negative inside.
 * Ellipsoids are taken as the sphere of their mean radius: good enough to tell limbs apart.
 */
export function surfaceDistance(geom: Geom, [x, y, z]: Vector): number {
  const [a = 0, b = 0, c = 0] = geom.size;
  switch (geom.type) {
    case "capsule": {
      const along = Math.min(Math.max(z, -b), b);
      return Math.hypot(x, y, z - along) - a;
    }
    case "cylinder":
      return Math.max(Math.hypot(x, y) - a, Math.abs(z) - b);
    case "box":
      return Math.max(Math.abs(x) - a, Math.abs(y) - b, Math.abs(z) - c);
    case "ellipsoid":
      return Math.hypot(x, y, z) - (a + b + c) / 3;
    default:
      return Math.hypot(x, y, z) - a;
  }
}

function inGeom(geom: Geom, pose: Pose, point: Vector): Vector {
  const inBody = rotate(inverse(pose.rotation), minus(point, pose.position));
  return rotate(inverse(geom.quat), minus(inBody, geom.pos));
}

/** The human geom nearest to a contact, as an index into `scene.geoms`; −1 when there is none. */
export function touchedGeom(scene: Scene, clip: Clip, contact: Contact): number {
  let nearest = -1;
  let distance = Infinity;
  scene.geoms.forEach((geom, index) => {
    if (geom.role !== "human") return;
    const pose = bodyPose(scene, clip, geom.body, contact.frame);
    const d = surfaceDistance(geom, inGeom(geom, pose, contact.at));
    if (d < distance) [nearest, distance] = [index, d];
  });
  return nearest;
}
