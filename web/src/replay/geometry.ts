/** MuJoCo's primitive shapes as three.js geometry; sizes are half-lengths, axes along z. */
import { BoxGeometry, BufferGeometry, CapsuleGeometry, CylinderGeometry, SphereGeometry } from "three";
import type { Geom } from "./clip.js";

/** A geom's surface in its own frame; null for shapes that are not drawn (planes, meshes). */
export function surfaceOf(geom: Geom): BufferGeometry | null {
  const [a = 0, b = 0, c = 0] = geom.size.map((v) => (Number.isFinite(v) ? Math.max(v, 0) : 0));
  switch (geom.type) {
    case "sphere":
      return new SphereGeometry(a, 28, 20);
    case "capsule":
      return new CapsuleGeometry(a, 2 * b, 10, 28).rotateX(Math.PI / 2);
    case "cylinder":
      return new CylinderGeometry(a, a, 2 * b, 36).rotateX(Math.PI / 2);
    case "box":
      return new BoxGeometry(2 * a, 2 * b, 2 * c);
    case "ellipsoid":
      return new SphereGeometry(1, 28, 20).scale(a, b, c);
    default:
      return null;
  }
}
