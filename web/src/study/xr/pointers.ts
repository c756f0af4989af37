/** Controllers and hands of a headset: where they are, where they point, what was pressed. */
import {
  BufferGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial, Raycaster, Vector3, type WebGLRenderer,
  type XRGripSpace, type XRHandSpace, type XRTargetRaySpace,
} from "three";
import type { Vector } from "../../replay/clip.js";
import type { Side } from "./placing.js";

/** The joint that stands for the hand: the middle of the palm. */
const PALM = "middle-finger-metacarpal";

interface Pointer {
  readonly ray: XRTargetRaySpace;
  readonly grip: XRGripSpace;
  readonly hand: XRHandSpace;
  readonly line: Line;
  source: XRInputSource | null;
}

export class Pointers {
  readonly #pointers: readonly Pointer[];
  readonly #caster = new Raycaster();
  readonly #line = new LineBasicMaterial();

  /** Adds both to `home`, which lies as the headset's coordinates do. */
  constructor(renderer: WebGLRenderer, home: Group, pressed: (index: number) => void) {
    const beam = new BufferGeometry().setAttribute("position", new Float32BufferAttribute([0, 0, 0, 0, 0, -2], 3));
    this.#pointers = [0, 1].map((index) => {
      const [ray, grip, hand] = [renderer.xr.getController(index), renderer.xr.getControllerGrip(index), renderer.xr.getHand(index)];
      const pointer: Pointer = { ray, grip, hand, line: new Line(beam, this.#line), source: null };
      ray.add(pointer.line);
      home.add(ray, grip, hand);
      ray.addEventListener("connected", ({ data }) => (pointer.source = data));
      ray.addEventListener("disconnected", () => (pointer.source = null));
      ray.addEventListener("select", () => pressed(index));
      return pointer;
    });
  }

  paint(color: string): void {
    this.#line.color.set(color);
  }

  /** Whether bare hands are tracked rather than controllers. */
  get areHands(): boolean {
    return this.#pointers.some(({ source }) => source?.hand != null);
  }

  /** The pointer that moves the arm: that of the same side, else whichever is there; −1 for none. */
  chosen(side: Side): number {
    const tracked = this.#pointers.map((pointer) => pointer.source !== null && this.#placeOf(pointer) !== null);
    const same = this.#pointers.findIndex(({ source }, i) => tracked[i] && source?.handedness === side);
    return same >= 0 ? same : tracked.indexOf(true);
  }

  #placeOf({ source, grip, hand }: Pointer): Group | null {
    const joint = source?.hand ? hand.joints[PALM] : grip;
    return joint?.visible ? joint : null;
  }

  /** Where a pointer's hand is in the world; null while it is not tracked. */
  place(index: number): Vector | null {
    const pointer = this.#pointers[index];
    const at = pointer && this.#placeOf(pointer);
    if (!at) return null;
    const { x, y, z } = at.getWorldPosition(new Vector3());
    return [x, y, z];
  }

  /** Calls `visit` with the ray of each pointer that is there; shows those for which it says so. */
  cast(visit: (ray: Raycaster, index: number) => boolean): void {
    this.#pointers.forEach(({ ray, source, line }, index) => {
      line.visible = source !== null && ray.visible && visit(this.#caster.setFromXRController(ray), index);
    });
  }

  /** A short, soft buzz in the hand. */
  buzz(index: number): void {
    const actuator = this.#pointers[index]?.source?.gamepad?.hapticActuators?.[0] as { pulse?: (value: number, ms: number) => unknown } | undefined;
    void actuator?.pulse?.(0.5, 60);
  }

  dispose(): void {
    for (const { ray, grip, hand, line } of this.#pointers) {
      for (const part of [ray, grip, hand]) part.removeFromParent();
      line.geometry.dispose();
    }
    this.#line.dispose();
  }
}
