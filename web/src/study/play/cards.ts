/** What is said around an episode, on the screen and in the headset alike. Pure. */
import { text } from "../../base/read.js";
import type { State, Words } from "../context.js";
import { headingOf } from "./briefing.js";
import type { Way } from "./devices.js";
import type { Action, Said } from "./hud.js";

/** The ways to move the hand, as things to press. */
export function choiceOf(ways: readonly Way[], best: Way | undefined, words: Words, choose: (way: Way) => void): Action[] {
  return ways.map((way) => ({
    id: way, label: words(`play.ways.${way}.name`), primary: way === best, run: () => choose(way),
  }));
}

export function countdown(state: State, words: Words, left: number): Said {
  return { layout: "count", heading: headingOf(state, words), line: String(left), hint: words("play.ready"), actions: [] };
}

/** While an episode runs: what to do, and with which keys or movements. */
export function running(state: State, words: Words, way: Way): Said {
  const { stage } = state;
  return {
    layout: "play", heading: headingOf(state, words), actions: [],
    line: text(stage["instructions"]) || words(`play.manner.${text(stage["manner"], "own-way")}.line`),
    hint: words(`play.ways.${way}.keys`),
  };
}

export function connectionLost(state: State, words: Words): Said {
  return {
    layout: "card", heading: headingOf(state, words), line: words("play.lost"), hint: words("play.lost-hint"), actions: [],
  };
}

/** No way back from here, but into this window where the study is open in another one. */
export function closed(words: Words, why: "link" | "elsewhere", goOnHere: () => void): Said {
  const here: Action = { id: "here", label: words("play.here"), primary: true, run: goOnHere };
  return { layout: "card", heading: "", line: words(`play.closed.${why}`), hint: words(`play.closed-hint.${why}`), actions: why === "elsewhere" ? [here] : [] };
}

export function noHeadset(state: State, words: Words, actions: readonly Action[]): Said {
  return { layout: "card", heading: headingOf(state, words), line: words("play.no-headset"), hint: "", actions };
}
