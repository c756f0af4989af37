/** Play in a headset: enter, calibrate, sit in the person's place, move the hand with one's own. */
import { Color, Group, PerspectiveCamera, Vector3 } from "three";
import { themeColor } from "../../base/theme.js";
import type { Vector } from "../../replay/clip.js";
import type { StudyContext } from "../context.js";
import type { Said } from "../play/hud.js";
import type { LiveView } from "../play/live-view.js";
import type { Reach } from "../play/target.js";
import { Calibration } from "./calibration.js";
import { Panel } from "./panel.js";
import { Person } from "./person.js";
import { placementFor, shoulderOf, type Body, type Head } from "./placing.js";
import { Pointers } from "./pointers.js";

/** Where the sign floats, in headset metres: ahead of and above the eyes. Ours. */
const SIGN = { ahead: 1.35, above: 0.25 };

export interface HeadsetHandlers {
  /** Stop was pressed on the sign. */
  stop(): void;
  /** The session ended, from inside or by taking the headset off. */
  left(): void;
  /** Time goes on while the screen's own pictures rest, at `now` [ms]. */
  draw(now: number): void;
}

export class Headset {
  /** Where the participant's hand is, in the world; the last place known while it is not tracked. */
  target: Vector | null = null;
  /** Of the pictures in the headset; null before the first second. */
  framesPerSecond: number | null = null;
  readonly #rig = new Group();
  readonly #home = new Group();
  readonly #eyes = new PerspectiveCamera(70, 1, 0.05, 30);
  readonly #panel = new Panel();
  readonly #pointers: Pointers;
  readonly #person: Person;
  readonly #calibration: Calibration;
  #session: XRSession | null = null;
  /** Where the participant sits; null before it was asked. */
  #place: { readonly head: Head; readonly body: Body } | null = null;
  #said: Said = { layout: "card", heading: "", line: "", hint: "", actions: [] };
  #left: number | null = null;
  #alert: string | null = null;
  #frames = { count: 0, since: 0 };

  constructor(private readonly live: LiveView, private readonly context: StudyContext, private readonly handlers: HeadsetHandlers) {
    const { world, renderer } = live.view;
    this.#home.rotation.x = Math.PI / 2; // The headset has y up, the world z.
    this.#home.add(this.#eyes, this.#panel.mesh);
    this.#rig.add(this.#home);
    world.add(this.#rig);
    this.#rig.visible = false;
    this.#pointers = new Pointers(renderer, this.#home, (index) => this.#press(index));
    this.#person = new Person(live);
    this.#calibration = new Calibration(context, {
      say: (said) => this.say(said),
      head: () => this.#headNow(),
      hand: (index) => this.#local(index),
      side: () => this.#person.side,
      seat: (head, body) => {
        this.#place = { head, body };
        this.#settle();
      },
    });
  }

  /** Whether a session goes on. */
  get present(): boolean {
    return this.#session !== null;
  }

  get device(): "xr-controller" | "xr-hand" {
    return this.#pointers.areHands ? "xr-hand" : "xr-controller";
  }

  /**
   * Begins a session; must be called within a press of a button.
   *
   * @throws Error The headset or the participant refused.
   */
  async enter(): Promise<void> {
    if (this.#session || !navigator.xr) return;
    const session = await navigator.xr.requestSession("immersive-vr", {
      requiredFeatures: ["local-floor"], optionalFeatures: ["hand-tracking"],
    });
    const { view } = this.live;
    session.addEventListener("end", () => this.#ended());
    view.renderer.xr.enabled = true;
    await view.renderer.xr.setSession(session as never);
    this.#session = session;
    this.#rig.visible = true;
    this.#pointers.paint(themeColor("--3d-target"));
    view.world.background = new Color(themeColor("--paper"));
    view.eyes = this.#eyes;
    view.renderer.setAnimationLoop((now) => this.#frame(now));
  }

  /** Asks for the participant's place and sizes; false where they left meanwhile. */
  async calibrated(): Promise<boolean> {
    return this.#calibration.run();
  }

  /** An episode begins whose person reaches so far. */
  begin(reach: Reach): void {
    this.#person.told = reach;
    this.#settle();
  }

  say(said: Said): void {
    this.#said = said;
    [this.#left, this.#alert] = [null, null];
    this.#show();
  }

  /** What changes while an episode runs: share of the time left, and what is so right now. */
  told(left: number, alert: string | null): void {
    if (alert !== null && this.#alert === null) this.#pointers.buzz(this.#pointers.chosen(this.#person.side));
    const shown = Math.ceil(left * 50) / 50; // Twenty times the writing would only cost time.
    if (shown === this.#left && alert === this.#alert) return;
    [this.#left, this.#alert] = [shown, alert];
    this.#show();
  }

  dispose(): void {
    void this.#session?.end().catch(() => undefined);
    this.#pointers.dispose();
    this.#panel.dispose();
    this.#rig.removeFromParent();
  }

  /** A trigger or pinch: presses what is pointed at, else does what comes first, so nobody must aim. */
  #press(index: number): void {
    if (this.#panel.press()) return;
    if (this.#calibration.waits) this.#calibration.press(index);
    else if (this.#said.layout === "card") this.#said.actions.find(({ primary }) => primary)?.run();
  }

  /** Sits the participant into the person's place. */
  #settle(): void {
    if (!this.#place) return;
    const { head, body } = this.#place;
    const { side, reach, facing } = this.#person;
    const placement = placementFor(head, shoulderOf(head, body.seat, side), body.arm, reach, facing);
    this.#rig.scale.setScalar(placement.scale);
    this.#rig.rotation.z = placement.yaw;
    this.#rig.position.set(...placement.position);
    this.#person.hideHead(true);
    this.#putSign(head);
  }

  #putSign({ position: [x, y, z], forward }: Head): void {
    const far = Math.hypot(forward[0], forward[2]) || 1;
    const { mesh } = this.#panel;
    mesh.position.set(x + (forward[0] / far) * SIGN.ahead, y + SIGN.above, z + (forward[2] / far) * SIGN.ahead);
    // Towards the eyes: the plane looks along its own +z.
    mesh.lookAt(this.#home.localToWorld(new Vector3(x, y, z)));
  }

  #headNow(): Head {
    const { x, y, z } = this.#eyes.position;
    const ahead = new Vector3(0, 0, -1).applyQuaternion(this.#eyes.quaternion);
    return { position: [x, y, z], forward: [ahead.x, ahead.y, ahead.z] };
  }

  /** Where a pointer's hand is in the headset's own coordinates. */
  #local(index: number): Vector | null {
    const at = this.#pointers.place(index);
    if (!at) return null;
    const { x, y, z } = this.#home.worldToLocal(new Vector3(...at));
    return [x, y, z];
  }

  #show(): void {
    const isPlay = this.#said.layout === "play";
    const corner = isPlay
      ? { label: this.context.words("vr.stop"), run: () => this.handlers.stop() }
      : { label: this.context.words("vr.leave"), run: () => void this.#session?.end() };
    this.#panel.show({ ...this.#said, left: this.#left, alert: this.#alert, corner });
  }

  #frame(now: number): void {
    this.#count(now);
    if (this.#place === null) this.#putSign(this.#headNow());
    const index = this.#pointers.chosen(this.#person.side);
    this.target = this.#pointers.place(index) ?? this.target;
    let pointed = false;
    this.#pointers.cast((ray, i) => {
      const hits: boolean = (!pointed || i === index) && this.#panel.point(ray);
      pointed ||= hits;
      return hits || this.#said.layout === "card";
    });
    this.handlers.draw(now);
    this.live.view.render();
  }

  #count(now: number): void {
    if (this.#frames.since === 0) this.#frames = { count: 0, since: now };
    this.#frames.count++;
    if (now - this.#frames.since < 1000) return;
    this.framesPerSecond = (1000 * this.#frames.count) / (now - this.#frames.since);
    this.#frames = { count: 0, since: now };
  }

  #ended(): void {
    const { view } = this.live;
    view.renderer.setAnimationLoop(null);
    view.renderer.xr.enabled = false;
    view.eyes = null;
    view.world.background = null;
    this.#person.hideHead(false);
    this.#session = null;
    this.#rig.visible = false;
    this.#place = null;
    this.target = null;
    this.#calibration.press(null);
    view.draw();
    this.handlers.left();
  }
}
