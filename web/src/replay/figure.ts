/** Everything that has a shape: one mesh per geom, one group per body, posed by a clip. */
import { Group, Mesh, MeshStandardMaterial } from "three";
import { restOf, type Clip, type Pose, type Scene } from "./clip.js";
import { surfaceOf } from "./geometry.js";
import { colorOf, type Look } from "./look.js";
import { poseAt } from "./pose.js";

function place(group: Group, { position, rotation: [w, x, y, z] }: Pose): void {
  group.position.set(...position);
  group.quaternion.set(x, y, z, w);
}

export class Figure {
  readonly root = new Group();
  readonly #bodies = new Map<number, Group>();
  readonly #meshes: (Mesh<never, MeshStandardMaterial> | null)[] = [];

  /** `ghost`: the human alone, translucent. */
  constructor(private readonly scene: Scene, private readonly ghost = false) {
    for (const geom of scene.geoms) {
      const surface = !ghost || geom.role === "human" ? surfaceOf(geom) : null;
      if (!surface || geom.role === "floor") {
        this.#meshes.push(null);
        continue;
      }
      const mesh = new Mesh(surface, new MeshStandardMaterial({ roughness: 0.72, metalness: 0 }));
      mesh.position.set(...geom.pos);
      mesh.quaternion.set(geom.quat[1], geom.quat[2], geom.quat[3], geom.quat[0]);
      mesh.castShadow = !ghost;
      mesh.receiveShadow = !ghost;
      this.#body(geom.body).add(mesh);
      this.#meshes.push(mesh as unknown as Mesh<never, MeshStandardMaterial>);
    }
  }

  #body(index: number): Group {
    const known = this.#bodies.get(index);
    if (known) return known;
    const group = new Group();
    place(group, restOf(this.scene, index));
    this.#bodies.set(index, group);
    this.root.add(group);
    return group;
  }

  /** Paints every geom for the theme. */
  paint(look: Look): void {
    this.scene.geoms.forEach((geom, index) => {
      const material = this.#meshes[index]?.material;
      if (!material) return;
      material.color.copy(this.ghost ? look.ghost : colorOf(geom, look));
      material.emissive.copy(look.unwanted);
      material.emissiveIntensity = 0;
      material.opacity = this.ghost ? 0.3 : geom.rgba[3];
      material.transparent = material.opacity < 1;
      material.depthWrite = !this.ghost;
    });
  }

  /** Moves the bodies to where they were at `time` [frames]; bodies the clip lacks stay. */
  pose(clip: Clip, time: number): void {
    const moving = new Set(clip.bodies);
    clip.bodies.forEach((body, slot) => {
      const group = this.#bodies.get(body);
      if (group) place(group, poseAt(clip, slot, time));
    });
    if (this.ghost) {
      // A ghost that stands still says nothing: only limbs that move are shown.
      for (const [body, group] of this.#bodies) group.visible = moving.has(body);
    }
  }

  /** Lights up geoms (index → 0..1) that are touched where they should not be. */
  flash(strength: ReadonlyMap<number, number>): void {
    this.#meshes.forEach((mesh, index) => {
      if (mesh) mesh.material.emissiveIntensity = 0.85 * (strength.get(index) ?? 0);
    });
  }

  /** Hides a body, such as the head of the person through whose eyes one looks. */
  hide(body: number, hidden: boolean): void {
    const group = this.#bodies.get(body);
    if (group) group.visible = !hidden;
  }

  /** Frees what the graphics card holds. */
  dispose(): void {
    for (const mesh of this.#meshes) {
      (mesh as Mesh | null)?.geometry.dispose();
      mesh?.material.dispose();
    }
  }
}
