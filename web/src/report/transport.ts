/** Play, scrub, speed, worst or median: the controls below the two 3D views. */
import { button, h, on } from "../base/dom.js";
import type { Signal } from "../base/signal.js";
import type { Clip } from "../replay/clip.js";
import { SPEEDS, type Clock } from "../replay/clock.js";
import { playButton } from "../replay/play-button.js";

export type Which = "worst" | "median";

export interface Transport {
  readonly element: HTMLElement;
  /** Takes the marks of another episode. */
  load(clip: Clip | null): void;
  /** Takes the keyboard to its first control, which plays. */
  focus(): void;
}

/** A set of buttons of which one is pressed. */
function choice<T extends string | number>(
  name: string,
  options: readonly (readonly [value: T, text: string])[],
  current: () => T,
  choose: (value: T) => void,
): { readonly element: HTMLElement; readonly refresh: () => void } {
  const buttons = options.map(([value, text]) => ({ value, element: button(text, () => choose(value)) }));
  const refresh = (): void =>
    buttons.forEach(({ value, element }) => element.setAttribute("aria-pressed", String(value === current())));
  refresh();
  const element = h("div", { class: "choice", role: "group", "aria-label": name }, ...buttons.map((b) => b.element));
  return { element, refresh };
}

function scrubber(clock: Clock): { readonly element: HTMLElement; readonly load: (clip: Clip | null) => void } {
  const slider = h("input", { type: "range", min: 0, max: 1, step: 1, "aria-label": "Time" });
  const marks = h("div", { class: "contact-marks", "aria-hidden": "true" });
  const now = h("output", { class: "time" });
  on(slider, { input: () => clock.seek(Number(slider.value)) });
  clock.time.watch((time) => {
    slider.value = String(time);
    const text = `${clock.seconds.toFixed(1)} s`;
    slider.setAttribute("aria-valuetext", text);
    slider.style.setProperty("--share", String(time / Math.max(1, clock.frames - 1)));
    now.textContent = text;
  });
  const load = (clip: Clip | null): void => {
    const last = Math.max(1, (clip?.frames ?? 2) - 1);
    slider.max = String(last);
    slider.disabled = clip === null;
    const unwanted = new Set(clip?.contacts.filter(({ kind }) => kind === "unwanted").map(({ frame }) => frame));
    marks.replaceChildren(...[...unwanted].map((frame) =>
      h("span", { class: "contact-mark", style: `--at: ${Math.min(1, Math.max(0, frame / last))}` })));
    marks.title = `${unwanted.size} moments with unwanted contact`;
  };
  return { element: h("div", { class: "scrubber" }, h("div", { class: "track" }, slider, marks), now), load };
}

/** The bar of controls. */
export function transport(
  clock: Clock,
  which: Signal<Which>,
  ghost: Signal<boolean>,
  resetViews: () => void,
): Transport {
  const scrub = scrubber(clock);
  const speed = choice<number>("Speed", SPEEDS.map((v) => [v, `${v}×`] as const), () => clock.speed, (value) => {
    clock.speed = value;
    speed.refresh();
  });
  const episode = choice<Which>("Episode", [["worst", "worst"], ["median", "median"]], () => which.value,
    (value) => (which.value = value));
  which.watch(episode.refresh);
  const overlay = button("overlay", () => (ghost.value = !ghost.value), {
    class: "quiet", title: "Lay the canonical human over the chosen one",
  });
  ghost.watch((shown) => overlay.setAttribute("aria-pressed", String(shown)));
  const reset = button("reset view", resetViews, { class: "quiet" });
  const play = playButton(() => clock.toggle(), { play: "Play", pause: "Pause" });
  clock.playing.watch(play.refresh);
  return {
    element: h("div", { class: "transport" }, play.element, scrub.element,
      h("div", { class: "transport-options" }, episode.element, speed.element, overlay, reset)),
    load: (clip) => {
      play.element.disabled = clip === null;
      scrub.load(clip);
    },
    focus: () => play.element.focus({ preventScroll: true }),
  };
}
