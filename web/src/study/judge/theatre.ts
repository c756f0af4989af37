/** The motions of a trial side by side: same moment, same viewpoint, and nothing but bodies. */
import { Vector3 } from "three";
import { button, h, on } from "../../base/dom.js";
import { theme } from "../../base/theme.js";
import type { Clip, Scene } from "../../replay/clip.js";
import { Clock } from "../../replay/clock.js";
import { playButton } from "../../replay/play-button.js";
import { View } from "../../replay/view.js";
import { viewpointFor, type Viewpoint } from "../../replay/viewpoint.js";
import type { Words } from "../context.js";
import type { Side } from "./questionnaire.js";

export type Role = Side | "reference";

const REST = 900; // [ms] at the end before it plays again. Ours.

class Pane {
  readonly element: HTMLElement;
  readonly view: View | null;

  constructor(readonly role: Role, scene: Scene, words: Words) {
    const name = words(`judge.motion.${role}`);
    const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": words("judge.picture", { name }) });
    this.element = h("figure", { class: `pane ${role}` }, h("figcaption", {}, name), canvas);
    this.view = View.create(canvas, scene);
  }
}

/** Narrow panes cut off what the viewpoint of a wide one shows. */
const FARTHER = 1.2;

/** The mean of viewpoints, so that neither of two motions is looked at more squarely. */
function between(viewpoints: readonly Viewpoint[]): Viewpoint {
  const mean = (part: (viewpoint: Viewpoint) => Vector3): Vector3 => viewpoints
    .reduce((sum, viewpoint) => sum.add(part(viewpoint)), new Vector3()).divideScalar(viewpoints.length);
  const target = mean((viewpoint) => viewpoint.target);
  return { target, position: mean(({ position }) => position).sub(target).multiplyScalar(FARTHER).add(target) };
}

export class Theatre {
  readonly element: HTMLElement;
  /** Whether this browser can draw. */
  readonly draws: boolean;
  readonly #panes: readonly Pane[];
  readonly #clock = new Clock();
  readonly #bar: HTMLElement;
  readonly #unwatch: () => void;
  #home: Viewpoint | null = null;
  /** Stills are drawn once. */
  #moving: readonly View[] = [];
  #again: ReturnType<typeof setTimeout> | undefined;
  #loops = false;

  /** `roles`: which panes there are, in reading order. */
  constructor(roles: readonly Role[], private readonly scene: Scene, words: Words) {
    this.#panes = roles.map((role) => new Pane(role, scene, words));
    this.draws = this.#panes.every(({ view }) => view !== null);
    for (const view of this.#views) {
      const others = this.#views.filter((other) => other !== view);
      view.onOrbit((position, target) => others.forEach((other) => other.lookFrom(position, target)));
      on(view.canvas, { dblclick: () => this.#reset() });
    }
    this.#bar = this.#transport(words);
    this.element = h("div", { class: roles.length === 3 ? "three" : "" },
      h("div", { class: "panes" }, ...this.#panes.map(({ element }) => element)), this.#bar);
    this.#unwatch = theme.watch(() => this.#restyle());
    this.#clock.time.watch((time) => this.#moving.forEach((view) => view.seek(time)));
    this.#clock.playing.watch((playing) => this.#rest(playing));
  }

  get #views(): readonly View[] {
    return this.#panes.flatMap(({ view }) => view ?? []);
  }

  /** Shows the motions of a trial from their beginning. */
  show(clips: Readonly<Record<Role, Clip | null>>): void {
    this.halt();
    const shown = this.#panes.flatMap(({ role }) => clips[role] ?? []);
    const guides = clips.reference ? [clips.reference] : shown;
    this.#home = between(guides.map((clip) => viewpointFor(this.scene, clip)));
    for (const { role, view } of this.#panes) view?.show(clips[role], false);
    this.#restyle();
    this.#reset();
    const longest = shown.reduce((a, b) => (b.frames > a.frames ? b : a));
    const moves = longest.frames > 1;
    this.#bar.hidden = !moves;
    this.#clock.load(longest.frames, longest.dt, 0);
    this.#moving = this.#panes.flatMap(({ role, view }) => ((clips[role]?.frames ?? 1) > 1 ? view ?? [] : []));
    this.#views.forEach((view) => view.seek(0));
    this.#slider.max = String(Math.max(1, longest.frames - 1));
    if (moves && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
  }

  /** Plays, again and again. */
  play(): void {
    this.#loops = true;
    this.#clock.play();
  }

  /** Rests until somebody plays it. */
  halt(): void {
    this.#loops = false;
    clearTimeout(this.#again);
    this.#clock.pause();
  }

  toggle(): void {
    if (this.#loops) this.halt();
    else this.play();
  }

  dispose(): void {
    this.halt();
    this.#unwatch();
    for (const view of this.#views) view.dispose();
  }

  #rest(playing: boolean): void {
    clearTimeout(this.#again);
    if (playing || !this.#loops) return;
    this.#again = setTimeout(() => this.#clock.play(), REST);
  }

  #reset(): void {
    const home = this.#home;
    if (home) this.#views.forEach((view) => view.lookFrom(home.position, home.target));
  }

  #restyle(): void {
    this.#views.forEach((view) => view.restyle(theme.value === "dark"));
  }

  readonly #slider = h("input", { type: "range", min: 0, max: 1, step: "any", value: 0 });

  #transport(words: Words): HTMLElement {
    const play = playButton(() => this.toggle(), { play: words("judge.play"), pause: words("judge.pause") });
    this.#slider.setAttribute("aria-label", words("judge.time"));
    on(this.#slider, { input: () => {
      this.halt();
      this.#clock.seek(Number(this.#slider.value));
    } });
    this.#clock.time.watch((time) => {
      this.#slider.value = String(time);
      this.#slider.setAttribute("aria-valuetext", words("judge.seconds", { time: this.#clock.seconds.toFixed(1) }));
    });
    this.#clock.playing.watch((playing) => play.refresh(playing || this.#loops));
    const reset = button(words("judge.reset"), () => this.#reset(), { class: "quiet" });
    return h("div", { class: "transport" }, play.element, this.#slider, reset);
  }
}
