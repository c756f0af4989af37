/** What happens on the screen of practise and play: instructions, countdown, episode, what comes next. */
import { button, h } from "../../base/dom.js";
import { theme } from "../../base/theme.js";
import type { Disposable, State, StudyContext } from "../context.js";
import { Headset } from "../xr/headset.js";
import * as cards from "./cards.js";
import { aboutDevice, type Way } from "./devices.js";
import { Episode } from "./episode.js";
import { Guide } from "./guide.js";
import { Hud, type Said } from "./hud.js";
import { Live } from "./live.js";
import type { LiveView } from "./live-view.js";
import { HandInput, TURN_PER_PRESS, type ScreenDevice } from "./pointer.js";

const COUNTDOWN = 3; // [s] Ours.

export class Session implements Disposable {
  readonly #hud: Hud;
  readonly #guide: Guide;
  readonly #hand: HandInput;
  readonly #socket: Live;
  readonly #ends: (() => void)[] = [];
  #state: State;
  #episode: Episode | null = null;
  /** What goes on: a countdown or episode begins anew after a lost connection, all else stays. */
  #phase: "brief" | "countdown" | "running" | "closed" = "brief";
  #waiting: Said | null = null;
  #timer = 0;
  #headset: Headset | null = null;
  #last = 0;

  constructor(
    private readonly context: StudyContext, theatre: HTMLElement,
    private readonly live: LiveView, ways: readonly Way[],
  ) {
    const { words, state, announce, api } = context;
    this.#state = state;
    this.#guide = new Guide(context, ways, {
      say: (said) => this.#say(said),
      begin: () => this.#begin(),
      enter: (step) => void this.#enter(step),
    });
    const turn = (sign: number): void => live.turn(sign * TURN_PER_PRESS, 0);
    this.#hud = new Hud(announce, h("div", { class: "turns" },
      button("⟲", () => turn(-1), { "aria-label": words("play.turn-left"), title: words("play.turn-left") }),
      button("⟳", () => turn(1), { "aria-label": words("play.turn-right"), title: words("play.turn-right") })));
    theatre.append(this.#hud.element);
    this.#hand = new HandInput(live);
    this.#ends.push(theme.watch((now) => live.restyle(now === "dark")));
    // Who watched examples sees the person already while reading; a locked clip would be a fault.
    if (state.stages.some(({ kind }) => kind === "watch")) {
      void api.clip("c0").then((clip) => clip && live.backdrop(clip)).catch(() => undefined);
    }
    this.#socket = new Live(api.live, {
      connected: () => this.#connected(),
      begun: (begun) => this.#episode?.begun(begun),
      frame: (frame) => this.#episode?.frame(frame),
      finished: () => void this.#finished(),
      lost: () => this.#lost(),
      closed: (why) => this.#closed(why),
      refused: (reason) => void this.#refused(reason),
    });
    requestAnimationFrame((now) => this.#draw(now));
  }

  /** Where the participant stands now: says what comes next. */
  update(state: State): void {
    this.#state = state;
    this.#stopTimer();
    this.#episode = null;
    this.#phase = "brief";
    this.#guide.brief(state);
  }

  #begin(): void {
    if (this.#guide.way === "vr" && !this.#headset?.present) return void this.#enter(null);
    if (!this.#socket.connected) return this.#lost();
    this.#phase = "countdown";
    this.#count(COUNTDOWN);
  }

  #count(left: number): void {
    if (left === 0) return this.#play();
    this.#say(cards.countdown(this.#state, this.context.words, left));
    this.#timer = window.setTimeout(() => this.#count(left - 1), 1000);
  }

  #play(): void {
    const onScreen = screenDevice(this.#guide.way);
    const inHeadset = this.#headset?.present ? this.#headset : null;
    const device = inHeadset?.device ?? onScreen;
    this.#phase = "running";
    this.#episode = new Episode(this.live, this.#hand, this.#headset, device);
    this.#say(cards.running(this.#state, this.context.words, inHeadset ? "vr" : onScreen));
    this.live.view.canvas.focus({ preventScroll: true });
    this.#socket.start(device, aboutDevice(this.#socket.roundTrip, this.#headset?.framesPerSecond ?? null));
  }

  /** The episode is on disk; its last movements are still to be seen. */
  async #finished(): Promise<void> {
    const episode = this.#episode;
    await episode?.shownToEnd();
    if (episode !== this.#episode) return;
    this.#endEpisode();
    this.context.proceed(await this.context.api.state());
  }

  #endEpisode(): void {
    this.#episode = null;
    this.#hand.end();
    this.#hud.alert(null);
    this.#hud.time(null, 1, "");
  }

  #say(said: Said): void {
    this.#hud.say(said);
    this.live.view.raise(this.#hud.hides);
    this.#headset?.say(said);
  }

  // The connection.

  #connected(): void {
    const waiting = this.#waiting;
    if (waiting === null) return;
    this.#waiting = null;
    if (this.#phase === "brief") this.#say(waiting);
    else void this.#again();
  }

  /** After a lost connection: the same episode from its beginning, unless it had been stored. */
  async #again(): Promise<void> {
    const before = this.#state;
    const state = await this.context.api.state();
    const isSame = ["kind", "index", "done"].every((field) => state.stage[field] === before.stage[field]);
    if (!isSame) return this.context.proceed(state);
    this.#begin();
  }

  #lost(): void {
    this.#stopTimer();
    this.#endEpisode();
    this.#waiting ??= this.#hud.said;
    this.#say(cards.connectionLost(this.#state, this.context.words));
  }

  #closed(why: "link" | "elsewhere"): void {
    this.#stopTimer();
    this.#endEpisode();
    this.#phase = "closed";
    this.#waiting = null;
    this.#say(cards.closed(this.context.words, why, () => location.reload()));
  }

  async #refused(reason: string): Promise<void> {
    if (reason !== "not-now" || this.#episode?.started) return;
    this.#endEpisode();
    this.context.proceed(await this.context.api.state());
  }

  // Stopping: what runs ends at once, and begins anew if they go on.

  pause(): void {
    this.#stopTimer();
    if (this.#phase === "running") this.#socket.stop();
    this.#endEpisode();
  }

  resume(): void {
    if (this.#phase === "running" || this.#phase === "countdown") this.update(this.#state);
  }

  #stopTimer(): void {
    clearTimeout(this.#timer);
  }

  // The headset.

  async #enter(step: number | null): Promise<void> {
    this.#headset ??= new Headset(this.live, this.context, {
      stop: () => {
        this.pause();
        this.resume();
      },
      left: () => this.#left(),
      draw: (now) => this.#step(now),
    });
    try {
      await this.#headset.enter();
    } catch {
      this.#say(cards.noHeadset(this.#state, this.context.words, this.#guide.choices(this.#state, step ?? 0)));
      return;
    }
    if (!(await this.#headset.calibrated())) return;
    if (step === null) this.#guide.last(this.#state);
    else this.#guide.chosen(this.#state, step);
  }

  /** The headset was taken off: what ran does not count. */
  #left(): void {
    if (this.#phase === "closed") return;
    this.pause();
    this.update(this.#state);
  }

  // Time.

  #draw(now: number): void {
    if (this.#phase === "closed" && this.#last < 0) return;
    if (!this.#headset?.present) this.#step(now);
    requestAnimationFrame((later) => this.#draw(later));
  }

  /** One picture, at `now` [ms]. */
  #step(now: number): void {
    const { words } = this.context;
    const seconds = Math.min(0.1, Math.max(0, (now - this.#last) / 1000));
    this.#last = now;
    const episode = this.#episode;
    if (!episode?.started) {
      this.live.show(performance.now() / 1000, null);
      return;
    }
    const { left, whole, target } = episode.step(seconds);
    this.#socket.target(episode.newest, target, performance.now());
    this.#hud.time(left, whole, words("play.left", { count: Math.ceil(left) }));
    this.#hud.alert(this.live.unwanted ? words("play.touched") : null);
    this.#headset?.told(left / whole, this.live.unwanted ? words("play.touched") : null);
  }

  dispose(): void {
    this.#phase = "closed";
    this.#last = -1;
    this.#stopTimer();
    this.#ends.forEach((end) => end());
    this.#socket.dispose();
    this.#hand.dispose();
    this.#headset?.dispose();
    this.live.dispose();
  }
}

/** The device on the screen; who chose the headset and has none on uses the mouse. */
function screenDevice(way: Way | null): ScreenDevice {
  return way === null || way === "vr" ? "mouse" : way;
}
