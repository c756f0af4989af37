/** The person of the scene, into whose place a participant sits: how they face, how far they reach. */
import { Vector3 } from "three";
import type { Vector } from "../../replay/clip.js";
import { bodyPose } from "../../replay/pose.js";
import { centersOf, facing } from "../../replay/viewpoint.js";
import { LiveClip } from "../play/live-clip.js";
import type { LiveView } from "../play/live-view.js";
import type { Reach } from "../play/target.js";
import { sideOf, type Side } from "./placing.js";

/** Until the first episode tells how far the person reaches [m]: a human arm. Ours. */
const USUAL_REACH = 0.65;

const AT_REST = new LiveClip({ bodies: [], substeps: 1, period: 0.1, horizon: 1, goal: null });

export class Person {
  /** As an episode told it; null before the first. */
  told: Reach | null = null;
  readonly #head: number;

  constructor(private readonly live: LiveView) {
    this.#head = live.scene.geoms.find(({ role, name }) => role === "human" && name.includes("head"))?.body ?? -1;
  }

  /** Their head is in the way of who looks through their eyes. */
  hideHead(hidden: boolean): void {
    if (this.#head >= 0) this.live.view.figure.hide(this.#head, hidden);
  }

  /** Middles of the person's limbs as they are first seen; before that, at rest. */
  get #limbs(): Vector3[] {
    const { scene, view } = this.live;
    return centersOf(scene, view.clip ?? AT_REST, "human", [0]);
  }

  /** Where they look, horizontally. */
  get facing(): Vector {
    const { x, y } = facing(this.#limbs);
    return x === 0 && y === 0 ? [0, 1, 0] : [x, y, 0];
  }

  /** How far the person reaches: as the episode says, else guessed from the arm that moves. */
  get reach(): Reach {
    if (this.told) return this.told;
    const { scene, view } = this.live;
    const clip = view.clip ?? AT_REST;
    const isHuman = (body: number): boolean => scene.geoms.some((geom) => geom.body === body && geom.role === "human");
    const arm = clip.bodies.find(isHuman) ?? scene.bodies.findIndex((name) => name.includes("shoulder"));
    return { shoulder: bodyPose(scene, clip, arm, 0).position, radius: USUAL_REACH };
  }

  /** Which of their arms is played. */
  get side(): Side {
    const limbs = this.#limbs;
    const middle = limbs.reduce((total, at) => total.add(at), new Vector3()).divideScalar(Math.max(1, limbs.length));
    return sideOf(this.reach.shoulder, [middle.x, middle.y, 0], this.facing);
  }
}
