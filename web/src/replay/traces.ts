/** What happened, drawn into the scene: paths of tool and itch, the itch itself, contacts. */
import { Color, Group, Mesh, MeshBasicMaterial, RingGeometry, SphereGeometry, type Camera, type Vector2 } from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import type { Clip, Contact, Scene, Vector } from "./clip.js";
import type { Look } from "./look.js";
import { bodyPose, carry, pathOf, tipOf } from "./pose.js";
import { touchedGeom } from "./touch.js";

/** How long a contact stays visible [frames]. */
const LINGER = 4;

/** A path: all of it faint, the part already travelled strong. */
class Trail {
  readonly root = new Group();
  readonly #faint: LineMaterial;
  readonly #strong: LineMaterial;
  readonly #travelled: LineGeometry;

  constructor(path: readonly Vector[]) {
    const flat = path.flat();
    const material = (opacity: number, linewidth: number): LineMaterial =>
      new LineMaterial({ linewidth, opacity, transparent: true, depthWrite: false });
    const geometry = (): LineGeometry => new LineGeometry().setPositions(flat);
    this.#faint = material(0.28, 1.5);
    this.#strong = material(0.95, 2.5);
    this.#travelled = geometry();
    this.root.add(new Line2(geometry(), this.#faint), new Line2(this.#travelled, this.#strong));
  }

  paint(color: Color): void {
    this.#faint.color.copy(color);
    this.#strong.color.copy(color);
  }

  update(time: number, size: Vector2): void {
    this.#travelled.instanceCount = Math.floor(time);
    this.#faint.resolution.copy(size);
    this.#strong.resolution.copy(size);
  }
}

/** The itch: a dot, and a ring that is seen through limbs and faces the reader. */
class ItchMark {
  readonly root = new Group();
  readonly #dot = new MeshBasicMaterial();
  readonly #ring = new MeshBasicMaterial({ depthTest: false, transparent: true });
  readonly #halo: Mesh;

  constructor() {
    this.#halo = new Mesh(new RingGeometry(0.03, 0.036, 40), this.#ring);
    this.#halo.renderOrder = 10;
    this.root.add(new Mesh(new SphereGeometry(0.014, 20, 14), this.#dot), this.#halo);
  }

  paint(color: Color): void {
    this.#dot.color.copy(color);
    this.#ring.color.copy(color);
  }

  update(position: Vector, camera: Camera): void {
    this.root.position.set(...position);
    camera.getWorldQuaternion(this.#halo.quaternion);
  }
}

/** Traces of one episode; without `trails` no paths, as for an episode that still goes on. */
export class Traces {
  readonly root = new Group();
  readonly #tip: Trail | null;
  readonly #itchPath: Trail | null;
  readonly #itch: ItchMark | null;
  readonly #contacts: readonly { readonly contact: Contact; readonly ball: Mesh<SphereGeometry, MeshBasicMaterial>; readonly geom: number }[];

  constructor(private readonly clip: Clip, private readonly scene: Scene, trails = true) {
    const tip = trails ? tipOf(scene) : null;
    const tipPath = tip && pathOf(clip, tip.body, tip.point);
    const itchPath = trails && clip.itch && pathOf(clip, clip.itch.body, clip.itch.pos);
    this.#tip = tipPath && new Trail(tipPath);
    this.#itchPath = itchPath ? new Trail(itchPath) : null;
    this.#itch = clip.itch && new ItchMark();
    const sphere = new SphereGeometry(1, 16, 12);
    this.#contacts = clip.contacts.map((contact) => ({
      contact,
      ball: new Mesh(sphere, new MeshBasicMaterial({ transparent: true, depthTest: contact.kind !== "unwanted" })),
      geom: contact.kind === "unwanted" ? touchedGeom(scene, clip, contact) : -1,
    }));
    for (const part of [this.#tip, this.#itchPath, this.#itch]) if (part) this.root.add(part.root);
    for (const { ball } of this.#contacts) this.root.add(ball);
  }

  paint(look: Look): void {
    this.#tip?.paint(look.tip);
    this.#itchPath?.paint(look.itch);
    this.#itch?.paint(look.itch);
    for (const { contact, ball } of this.#contacts) {
      ball.material.color.copy(look[contact.kind]);
    }
  }

  /** Shows the moment `time` [frames]; returns how strongly each geom is hit, 0..1. */
  update(time: number, camera: Camera, size: Vector2): Map<number, number> {
    this.#tip?.update(time, size);
    this.#itchPath?.update(time, size);
    const { itch } = this.clip;
    if (itch) {
      const pose = bodyPose(this.scene, this.clip, itch.body, time);
      this.#itch?.update(carry(pose, itch.pos), camera);
    }
    const hits = new Map<number, number>();
    for (const { contact, ball, geom } of this.#contacts) {
      const age = time - contact.frame;
      const freshness = age < -0.5 ? 0 : Math.max(0, 1 - Math.max(0, age) / LINGER);
      ball.visible = freshness > 0;
      if (!ball.visible) continue;
      ball.position.set(...contact.at);
      ball.scale.setScalar(ballRadius(contact));
      ball.material.opacity = 0.25 + 0.7 * freshness;
      if (geom >= 0) hits.set(geom, Math.max(hits.get(geom) ?? 0, freshness));
    }
    return hits;
  }

  dispose(): void {
    this.root.traverse((object) => {
      if (!(object instanceof Mesh)) return;
      object.geometry.dispose();
      (object.material as MeshBasicMaterial).dispose();
    });
  }
}

/** Radius [m] of a contact's mark: harder contacts are larger, up to a bound. */
function ballRadius({ kind, force }: Contact): number {
  if (kind !== "unwanted") return 0.011;
  return 0.016 + 0.014 * Math.min(1, Math.max(0, Number.isFinite(force) ? force : 0) / 20);
}
