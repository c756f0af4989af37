/** The 3D view of live play: the growing episode, and the marks of hand and target. */
import {
  BufferAttribute, BufferGeometry, CircleGeometry, Color, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial,
  SphereGeometry, Vector3,
} from "three";
import { themeColor } from "../../base/theme.js";
import type { Clip, Scene, Vector } from "../../replay/clip.js";
import { moved } from "../../replay/orbit.js";
import { View } from "../../replay/view.js";
import type { Frame } from "./frame.js";
import { LiveClip, type LiveSettings } from "./live-clip.js";
import { Pacer } from "./pacer.js";
import { Pace, stepBack } from "../pace.js";
import type { Sight } from "./target.js";

const plain = ({ x, y, z }: Vector3): Vector => [x, y, z];

/** The hand's target: a ball, a thread to the hand, and a plumb line that tells its place on the floor. */
class TargetMark {
  readonly root = new Group();
  readonly #fill = new MeshBasicMaterial({ transparent: true, opacity: 0.35, depthWrite: false });
  readonly #core = new MeshBasicMaterial({ depthTest: false, transparent: true });
  readonly #line = new LineBasicMaterial({ transparent: true, opacity: 0.8 });
  readonly #thread = new Line(points(2), this.#line);
  readonly #plumb = new Line(points(2), this.#line);
  readonly #ball = new Mesh(new SphereGeometry(0.055, 24, 16), this.#fill);
  readonly #dot = new Mesh(new SphereGeometry(0.012, 16, 12), this.#core);
  readonly #foot = new Mesh(new CircleGeometry(0.05, 32), this.#fill);

  constructor() {
    this.#dot.renderOrder = 11;
    for (const line of [this.#thread, this.#plumb]) line.frustumCulled = false;
    this.root.add(this.#ball, this.#dot, this.#foot, this.#thread, this.#plumb);
  }

  paint(): void {
    const color = new Color(themeColor("--3d-target"));
    for (const material of [this.#fill, this.#core, this.#line]) material.color.copy(color);
  }

  update(target: Vector, hand: Vector): void {
    this.#ball.position.set(...target);
    this.#dot.position.set(...target);
    this.#foot.position.set(target[0], target[1], 0.003);
    span(this.#thread, hand, target);
    span(this.#plumb, target, [target[0], target[1], 0]);
  }

  dispose(): void {
    for (const part of [this.#ball, this.#dot, this.#foot, this.#thread, this.#plumb]) part.geometry.dispose();
    for (const material of [this.#fill, this.#core, this.#line]) material.dispose();
  }
}

function points(count: number): BufferGeometry {
  return new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(3 * count), 3));
}

function span(line: Line<BufferGeometry>, from: Vector, to: Vector): void {
  const at = line.geometry.getAttribute("position") as BufferAttribute;
  at.setXYZ(0, ...from).setXYZ(1, ...to);
  at.needsUpdate = true;
}

export class LiveView {
  readonly #mark = new TargetMark();
  readonly #touching: ReadonlyMap<number, number>;
  #clip: LiveClip | null = null;
  #pacer: Pacer | null = null;
  #hand: Vector = [0, 0, 0];
  #unwanted = false;
  readonly #pace = new Pace();

  private constructor(readonly view: View, readonly scene: Scene) {
    view.controls.enabled = false; // Pointers and keys move the hand; see pointer.ts.
    view.canvas.style.touchAction = "none";
    this.#touching = new Map(scene.geoms.flatMap(({ role }, index) =>
      role === "robot" || role === "tool" ? [[index, 0.9] as const] : []));
    view.world.add(this.#mark.root);
    this.#mark.root.visible = false;
  }

  /** A view on `canvas`, or null where the browser has no WebGL. */
  static create(canvas: HTMLCanvasElement, scene: Scene): LiveView | null {
    const view = View.create(canvas, scene);
    return view && new LiveView(view, scene);
  }

  /** Something to look at before the first episode: the start of another one. */
  backdrop(clip: Clip): void {
    if (this.#clip) return;
    this.#open(clip);
    this.view.seek(0);
  }

  #open(clip: Clip): void {
    const isFirst = this.view.clip === null;
    this.view.show(clip, false);
    if (isFirst) stepBack(this.view);
  }

  restyle(dark: boolean): void {
    this.#mark.paint();
    this.view.restyle(dark);
  }

  begin(settings: LiveSettings): void {
    this.#clip = new LiveClip(settings);
    this.#pacer = new Pacer(settings.period);
    this.#unwanted = false;
  }

  /** Takes what a step brought, at `now` [s]; whether this is the first picture of the episode. */
  take(frame: Frame, now: number): boolean {
    if (!this.#clip?.take(frame)) return false;
    this.#pacer?.arrived(frame.step, now);
    this.#hand = frame.hand;
    this.#unwanted = frame.unwanted;
    if (frame.step === 0) this.#open(this.#clip);
    return frame.step === 0;
  }

  /** Where the played hand was last [m]. */
  get hand(): Vector {
    return this.#hand;
  }

  /** Whether the robot touches the person where it should not, as far as is known. */
  get unwanted(): boolean {
    return this.#unwanted;
  }

  /** Shows the moment `now` [s] with the hand's target, or without; returns the steps shown so far. */
  show(now: number, target: Vector | null): number {
    const steps = this.#pacer?.at(now) ?? 0;
    if (this.#pace.isSlow(now)) this.view.simplify();
    this.#mark.root.visible = target !== null;
    if (target) this.#mark.update(target, this.#hand);
    this.view.glow = this.#unwanted ? this.#touching : null;
    this.view.seek(this.#clip ? steps * this.#clip.settings.substeps : 0);
    return steps;
  }

  /** The camera now, for moving things in the picture. */
  sight(): Sight {
    const { camera, canvas } = this.view;
    camera.updateMatrixWorld();
    const [right, up, back] = [new Vector3(), new Vector3(), new Vector3()];
    camera.matrixWorld.extractBasis(right, up, back);
    return {
      position: plain(camera.position), right: plain(right), up: plain(up), forward: plain(back.negate()),
      angle: (camera.fov * Math.PI) / 180, height: canvas.clientHeight,
    };
  }

  /** Turns the camera around what it looks at [rad, rad, factor]. */
  turn(around: number, up: number, scale = 1): void {
    const { camera, controls } = this.view;
    const offset = moved(camera.position.clone().sub(controls.target), [around, up, scale]);
    this.view.lookFrom(controls.target.clone().add(offset), controls.target.clone());
  }

  dispose(): void {
    this.#mark.dispose();
    this.view.dispose();
  }
}
