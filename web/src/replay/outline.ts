/** A scene flattened: outlines of MuJoCo's round shapes in a view without perspective. */
import type { Geom, Pose, Vector } from "./clip.js";
import { carry, rotate } from "./pose.js";

export type Point = readonly [x: number, y: number];

/** A line as thick as the limb with round ends, or an ellipse as the matrix of a unit circle [m]. */
export type Outline =
  | { readonly kind: "limb"; readonly from: Point; readonly to: Point; readonly radius: number }
  | { readonly kind: "ellipse"; readonly matrix: readonly [number, number, number, number, number, number] };

/** The two directions of the picture, unit vectors; y grows downwards. */
export interface Picture {
  readonly right: Vector;
  readonly down: Vector;
}

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** The picture that is seen from `direction` (from the target to the eye), upright. */
export function pictureFrom([x, y, z]: Vector): Picture {
  const across = Math.hypot(x, y);
  const length = Math.hypot(across, z);
  if (length === 0 || across === 0) return { right: [1, 0, 0], down: [0, 0, -1] };
  const right: Vector = [-y / across, x / across, 0];
  const tilt = z / length / across;
  return { right, down: [x * tilt, y * tilt, -across / length] };
}

/** Where a point of the world appears [m]. */
export function appear({ right, down }: Picture, at: Vector): Point {
  return [dot(right, at), dot(down, at)];
}

/** How a geom of a body looks; null for boxes, cylinders and whatever else has edges. */
export function outlineOf(geom: Geom, body: Pose, picture: Picture): Outline | null {
  const [a = 0, b = 0, c = 0] = geom.size;
  const place = (point: Vector): Vector => {
    const [x, y, z] = rotate(geom.quat, point);
    return carry(body, [geom.pos[0] + x, geom.pos[1] + y, geom.pos[2] + z]);
  };
  const center = place([0, 0, 0]);
  if (geom.type === "sphere" || geom.type === "capsule") {
    const half = geom.type === "sphere" ? 0 : b;
    const ends = [place([0, 0, -half]), place([0, 0, half])].map((end) => appear(picture, end));
    return { kind: "limb", from: ends[0] as Point, to: ends[1] as Point, radius: a };
  }
  if (geom.type !== "ellipsoid") return null;
  const axes: readonly Vector[] = [[a, 0, 0], [0, b, 0], [0, 0, c]];
  return { kind: "ellipse", matrix: shadow(axes.map((axis) => place(axis)), center, picture) };
}

/** An ellipsoid's shadow: any root of the sum of its axes' outer products draws it. */
function shadow(tips: readonly Vector[], center: Vector, picture: Picture): [number, number, number, number, number, number] {
  const [cx, cy] = appear(picture, center);
  let [xx, xy, yy] = [0, 0, 0];
  for (const tip of tips) {
    const [px, py] = appear(picture, tip);
    const [x, y] = [px - cx, py - cy];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const first = Math.sqrt(xx);
  const mixed = first > 0 ? xy / first : 0;
  return [first, mixed, 0, Math.sqrt(Math.max(0, yy - mixed * mixed)), cx, cy];
}
