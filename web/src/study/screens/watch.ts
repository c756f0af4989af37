/** Canonical episodes, one after the other, before the participant plays. */
import { button, h, on } from "../../base/dom.js";
import { list, number, text } from "../../base/read.js";
import { theme } from "../../base/theme.js";
import { Clock } from "../../replay/clock.js";
import { View } from "../../replay/view.js";
import type { Mount, State } from "../context.js";
import { Pace, stepBack } from "../pace.js";
import { sending } from "./sending.js";

export const mountWatch: Mount = (root, { api, words, state, proceed, announce }) => {
  const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": words("watch.picture") });
  const line = h("p", { class: "line" });
  const count = h("p", { class: "count" });
  const clock = new Clock();
  const bar = h("div", { class: "progress", "aria-hidden": "true" }, h("span", {}));
  const play = button("", () => clock.toggle(), { "data-start": true });
  const next = button(words("shell.next"), () => void go(), { class: "primary" });
  const controls = h("div", { class: "actions" }, play, next);
  const key = h("ul", { class: "key" }, ...["person", "robot", "goal"].map((part) =>
    h("li", {}, h("span", { class: `swatch ${part}`, "aria-hidden": "true" }), words(`watch.key.${part}`))));
  root.append(h("div", { class: "theatre" }, canvas,
    h("div", { class: "hud top" }, count, bar), h("div", { class: "hud bottom" }, line, key, controls)));

  const pace = new Pace();
  let view: View | null = null;
  let now: State = state;
  let shown: string | null = null;
  let gone = false;
  const repaint = (): void => view?.restyle(theme.value === "dark");
  const unwatch = theme.watch(repaint);

  /** The episode that comes next in a state of this stage; null where none is left. */
  const upcoming = (at: State): readonly [name: string, seen: number, of: number] | null => {
    const episodes = list(at.stage["episodes"]).map((name) => text(name));
    const seen = number(at.stage["seen"]) ?? 0;
    const name = at.stage["kind"] === "watch" && at.stage["index"] === state.stage["index"] ? episodes[seen] : undefined;
    return name === undefined ? null : [name, seen, episodes.length];
  };

  const load = async (): Promise<void> => {
    const comes = upcoming(now);
    if (!comes) return proceed(now);
    const [episode, seen, of] = comes;
    count.textContent = words("watch.count", { number: seen + 1, of });
    line.textContent = words("watch.loading");
    next.disabled = true;
    const [scene, clip] = await Promise.all([api.scene(), api.clip(episode)]);
    if (gone) return;
    view ??= scene && View.create(canvas, scene);
    shown = episode;
    if (!view || !clip) {
      line.textContent = words(view ? "watch.missing" : "shell.no-webgl");
      next.disabled = !view;
      return;
    }
    const isFirst = view.clip === null;
    view.show(clip, false);
    if (isFirst) stepBack(view);
    repaint();
    line.textContent = text(now.stage["instructions"]) || words("watch.look");
    announce(`${count.textContent ?? ""}. ${line.textContent ?? ""}`);
    clock.load(clip.frames, clip.dt, 0);
    if (document.activeElement === document.body) play.focus(); // Next rests until the end.
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) clock.play();
    name();
  };
  /** The button says what it does now. */
  const name = (): void => {
    const isOver = clock.time.value >= clock.frames - 1;
    play.textContent = words(clock.playing.value ? "watch.pause" : isOver ? "watch.again" : "watch.play");
  };
  const go = async (): Promise<void> => {
    const episode = shown;
    if (episode === null) return;
    clock.pause();
    await sending(controls, words, announce, async () => {
      now = await api.post("watched", { stage: state.stage["index"], episode });
    });
    await load();
  };
  clock.time.watch((time) => {
    view?.seek(time);
    if (clock.playing.value && pace.isSlow(performance.now() / 1000)) view?.simplify();
    const share = time / Math.max(1, clock.frames - 1);
    (bar.firstElementChild as HTMLElement).style.width = `${100 * share}%`;
    if (share < 1 || shown === null) return;
    if (!next.disabled) return;
    next.disabled = false; // It was seen to its end.
    line.textContent = words(upcoming(now)?.[1] === (upcoming(now)?.[2] ?? 0) - 1 ? "watch.last" : "watch.seen");
    announce(line.textContent);
  });
  clock.playing.watch(name);
  on(canvas, { dblclick: () => view?.reset() });
  void load();
  let rests = false;
  return {
    pause: () => {
      rests = clock.playing.value;
      clock.pause();
    },
    resume: () => {
      if (rests) clock.play();
    },
    dispose: () => {
      gone = true;
      unwatch();
      clock.pause();
      view?.dispose();
    },
  };
};
