/** Leads through the sentences before an episode, and knows how the participant moves the hand. */
import type { State, StudyContext } from "../context.js";
import { briefing, headingOf } from "./briefing.js";
import { choiceOf } from "./cards.js";
import { rememberedWay, rememberWay, type Way } from "./devices.js";
import type { Action, Said } from "./hud.js";

export interface GuideHandlers {
  say(said: Said): void;
  /** Everything was said, and Start pressed. */
  begin(): void;
  /** The headset was chosen at `step`; the guide goes on with `chosen` or `last`. */
  enter(step: number): void;
}

export class Guide {
  #way: Way | null;

  constructor(
    private readonly context: StudyContext, readonly ways: readonly Way[], private readonly handlers: GuideHandlers,
  ) {
    this.#way = rememberedWay(context.state.participant.code, ways);
  }

  /** How the hand is moved; null before it was chosen. */
  get way(): Way | null {
    return this.#way;
  }

  /** One sentence after the other from `step` on, then the start. */
  brief(state: State, step = 0): void {
    const { words } = this.context;
    const steps = briefing(state, words, this.#way);
    const at = steps[step];
    if (at === undefined) return this.handlers.begin();
    const isLast = step === steps.length - 1;
    const go: Action = isLast
      ? { id: "start", label: words("play.start"), primary: true, run: () => this.handlers.begin() }
      : { id: "next", label: words("shell.next"), primary: true, run: () => this.brief(state, step + 1) };
    const mayChange = isLast && this.ways.length > 1 && state.stage["kind"] === "practise" && at.kind !== "ways";
    const others: Action[] = mayChange
      ? [{ id: "ways", label: words("play.other-way"), run: () => this.#forget(state) }] : [];
    this.handlers.say({
      layout: "card", heading: headingOf(state, words), line: at.line, hint: at.hint,
      actions: at.kind === "ways" ? this.choices(state, step) : [go, ...others],
    });
  }

  /** The last sentence, which Start follows. */
  last(state: State): void {
    this.brief(state, briefing(state, this.context.words, this.#way).length - 1);
  }

  /** What to press to choose a way; the best one first. */
  choices(state: State, step: number): Action[] {
    const best = this.#way ?? this.ways[0];
    return choiceOf(this.ways, best, this.context.words, (way) => {
      this.#way = way;
      rememberWay(state.participant.code, way);
      if (way === "vr") this.handlers.enter(step);
      else this.chosen(state, step);
    });
  }

  /** The answer at `step` is given: on with what follows it, where it stays among the steps. */
  chosen(state: State, step: number): void {
    const at = briefing(state, this.context.words, this.#way)[step];
    this.brief(state, at?.kind === "ways" ? step + 1 : step);
  }

  #forget(state: State): void {
    this.#way = null;
    this.brief(state, briefing(state, this.context.words, null).findIndex(({ kind }) => kind === "ways"));
  }
}
