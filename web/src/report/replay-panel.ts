/** The failure itself: the chosen episode beside canonical play from the same start. */
import { button, caption, h } from "../base/dom.js";
import { fixed } from "../base/format.js";
import { Signal } from "../base/signal.js";
import { theme } from "../base/theme.js";
import { StripRow, type Strip } from "../chart/strip.js";
import type { Clip } from "../replay/clip.js";
import { Clock } from "../replay/clock.js";
import { tellingFrame } from "../replay/pose.js";
import { View } from "../replay/view.js";
import type { Payload, Point } from "./payload.js";
import { transport, type Which } from "./transport.js";
import { outcomeText, title, watchable } from "./words.js";

/** A moment of an episode of the chosen human, to be shown. */
export interface Moment {
  readonly which: Which;
  readonly frame: number;
}

/** One pane: a canvas with its name and its ending. */
class Pane {
  readonly element: HTMLElement;
  readonly view: View | null;
  readonly #name = h("span", { class: "pane-name" });
  readonly #ending = h("span", { class: "pane-ending" });
  readonly #message = h("p", { class: "pane-message", hidden: true });
  readonly #canvas: HTMLCanvasElement;

  constructor(payload: Payload, kind: string) {
    this.#canvas = h("canvas", { tabindex: 0, role: "img" });
    this.view = payload.scene && View.create(this.#canvas, payload.scene);
    this.element = h("div", { class: `pane ${kind}` },
      h("div", { class: "pane-head" }, this.#name, this.#ending), this.#canvas, this.#message);
  }

  show(name: string, clip: Clip | null, missing: string): void {
    this.#name.textContent = name;
    this.#ending.textContent = clip ? outcomeText(clip.outcome) : "";
    this.#ending.className = `pane-ending ${clip?.outcome === "unwanted_contact" ? "bad" : ""}`;
    this.#message.textContent = this.view ? missing : "This browser has no WebGL, so motions cannot be drawn.";
    this.#message.hidden = clip !== null && this.view !== null;
    this.#canvas.setAttribute("aria-label",
      clip ? `${name}: ${outcomeText(clip.outcome)}. Arrow keys turn the view, plus and minus zoom.` : missing);
    this.view?.show(clip);
  }
}

function strips(clip: Clip, canonical: Clip | null, physical: boolean, goal: string): Strip[] {
  const other = (values: readonly number[] | undefined): Strip["series"] =>
    values?.length ? [{ kind: "canonical", values }] : [];
  const counts = (name: string, atLeast: number, values: readonly number[] = [], beside?: readonly number[]): Strip[] =>
    values.length === 0 ? [] : [{ title: name, atLeast, format: (v) => fixed(v, 0),
      series: [{ kind: "plain", values }, ...other(beside)] }];
  const centimetres = (values: readonly number[]): number[] => values.map((v) => 100 * v);
  return [
    { title: physical ? "unwanted force" : "unwanted force*", atLeast: 5, format: (v) => `${fixed(v, 1)} N`,
      series: [{ kind: "unwanted", values: clip.forceUnwanted, filled: true }, ...other(canonical?.forceUnwanted)] },
    { title: physical ? `force at the ${goal}` : `force at the ${goal}*`, atLeast: 5, format: (v) => `${fixed(v, 1)} N`,
      series: [{ kind: "itch", values: clip.forceItch }, ...other(canonical?.forceItch)] },
    { title: `tool to ${goal}`, atLeast: 10, format: (v) => `${fixed(v, 1)} cm`,
      series: [{ kind: "plain", values: centimetres(clip.distance) },
        ...other(canonical && centimetres(canonical.distance) || undefined)] },
    ...counts("counted contacts", 10, clip.counted, canonical?.counted),
    ...counts("pieces eaten", 8, clip.eaten, canonical?.eaten),
    ...counts("pieces fallen", 8, clip.spilled, canonical?.spilled),
  ];
}

function pictureKey(goal: string): HTMLElement {
  const item = (kind: string, name: string): HTMLElement =>
    h("li", {}, h("span", { class: `swatch ${kind}` }), name);
  return h("ul", { class: "legend picture-key" },
    item("itch-dot", `${goal} and its path`), item("tip-line", "path of the tool"),
    item("unwanted-dot", "unwanted contact"), item("canonical-line", "canonical play, same start"));
}

/** The panel for the chosen point; without stored replays, a sentence that says so. */
export function replayPanel(
  payload: Payload, chosen: Signal<Point | null>, physical: boolean, moment: Signal<Moment | null>,
): HTMLElement {
  if (!watchable(payload) || !payload.scene) {
    return h("section", { class: "replay", "aria-label": "Replay" },
      h("p", { class: "empty" }, payload.scene
        ? "Replays were not stored with this frontier, so there is no motion to watch."
        : "This task shows no picture, so there is no motion to watch."));
  }
  const { goal } = payload.scene;
  const clock = new Clock();
  const which = new Signal<Which>("worst");
  const ghost = new Signal(false);
  const attack = new Pane(payload, "attack");
  const natural = new Pane(payload, "natural");
  const views = [attack.view, natural.view].filter((view) => view !== null);
  for (const view of views) {
    const others = views.filter((other) => other !== view);
    view.onOrbit((position, target) => others.forEach((other) => other.lookFrom(position, target)));
  }
  const rows = h("div", { class: "strips" });
  const says = h("p", { class: "failure-says" });
  const bar = transport(clock, which, ghost, () => views.forEach((view) => view.reset()));
  let live: StripRow[] = [];
  let beside: Clip | null = null;

  const load = (point: Point | null): void => {
    const wasPlaying = clock.playing.value;
    clock.pause();
    const clip = point && payload.replays.point(point.id, which.value);
    beside = clip && payload.replays.canonical(clip.seed);
    const name = point ? title(point) : "";
    attack.show(name, clip, "No episode of this human was stored.");
    natural.show("canonical, same start", beside, clip ? "No canonical episode with this start was stored." : "");
    attack.view?.overlay(ghost.value ? beside : null);
    live = clip ? strips(clip, beside, physical, goal).map((strip) => new StripRow(strip, clip.frames, (t) => clock.seek(t))) : [];
    rows.replaceChildren(...live.map(({ element }) => element));
    says.replaceChildren(...(clip ? wentWrong(clip, (frame) => clock.seek(frame)) : []));
    bar.load(clip);
    clock.load(clip?.frames ?? 1, clip?.dt ?? 0.1, clip && !wasPlaying ? tellingFrame(clip) : 0);
    tick(clock.time.value);
    if (wasPlaying && clip) clock.play();
  };
  const tick = (time: number): void => {
    for (const view of views) view.seek(time);
    for (const row of live) row.seek(time);
  };
  theme.watch((now) => views.forEach((view) => view.restyle(now === "dark")));
  clock.time.watch(tick);
  chosen.watch(load);
  which.watch(() => load(chosen.value));
  ghost.watch((shown) => attack.view?.overlay(shown ? beside : null));

  const figure = h("figure", { class: "replay", "aria-label": "Replay" },
    h("div", { class: "panes" }, attack.element, natural.element), bar.element, says, rows, pictureKey(goal),
    caption(
      "An episode of the chosen human beside canonical play from the same start, at the same moment.",
      physical
        ? "One episode shows how a failure looks, not how often it happens: for that, see the outcomes below."
        : "One episode shows how a failure looks, not how often it happens. *Forces are not physical: the paper's servo caps every joint at 1 N·m.",
      "Drag to turn both.",
    ));
  moment.watch((next) => {
    if (next === null) return;
    which.value = next.which;
    clock.seek(next.frame);
    figure.scrollIntoView({ block: "nearest" });
    bar.focus(); // Enter plays it, wherever the page was.
  });
  return figure;
}

/** A sentence on what went wrong, which leads to the moment. */
function wentWrong({ failure, dt }: Clip, seek: (frame: number) => void): Node[] {
  if (failure === null) return [];
  const when = button(`${fixed(failure.frame * dt, 1)} s`, () => seek(failure.frame), { class: "link" });
  return [document.createTextNode("What went wrong, at "), when, document.createTextNode(`: ${failure.says}.`)];
}

