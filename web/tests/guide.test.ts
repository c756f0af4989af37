import assert from "node:assert/strict";
import { test } from "node:test";
import { readState } from "../src/study/api.js";
import type { StudyContext } from "../src/study/context.js";
import { Guide } from "../src/study/play/guide.js";
import type { Said } from "../src/study/play/hud.js";
import { wordsOf } from "../src/study/words.js";

const state = (kind: string, done: number) =>
  readState({ participant: { code: "P01" }, stage: { kind, index: 1, of: 2, done, manner: "own-way" } });

/** A guide without texts, so that each sentence is its key; `said` holds the last card. */
function guided(begins: () => void = () => undefined, enters: (step: number) => void = () => undefined) {
  const cards: Said[] = [];
  const context = { state: state("practise", 0), words: wordsOf({}, "en") } as unknown as StudyContext;
  const guide = new Guide(context, ["vr", "mouse"], { say: (said) => cards.push(said), begin: begins, enter: enters });
  const press = (id: string): void => cards.at(-1)?.actions.find((action) => action.id === id)?.run();
  return { guide, press, line: () => cards.at(-1)?.line, actions: () => cards.at(-1)?.actions.map(({ id }) => id) };
}

test("the first practice explains, asks how to move, says how that works, and starts last", () => {
  let begun = 0;
  const { guide, press, line, actions } = guided(() => begun++);
  guide.brief(state("practise", 0));
  assert.equal(line(), "play.role");
  press("next");
  assert.deepEqual(actions(), ["vr", "mouse"]);
  press("mouse");
  assert.equal(line(), "play.ways.mouse.how");
  press("next");
  assert.deepEqual(actions(), ["start", "ways"]);
  press("start");
  assert.deepEqual([begun, guide.way], [1, "mouse"]);
});

test("the next episode has one sentence, and play does not change the way", () => {
  const { guide, press, line, actions } = guided();
  guide.brief(state("practise", 0));
  press("next");
  press("mouse");
  guide.brief(state("play", 1));
  assert.equal(line(), "play.manner.own-way.again");
  assert.deepEqual(actions(), ["start"]);
});

test("who forgot the way is asked again, and the headset is entered before it goes on", () => {
  const entered: number[] = [];
  const { guide, press, line, actions } = guided(undefined, (step) => entered.push(step));
  guide.brief(state("play", 0));
  assert.deepEqual(actions(), ["vr", "mouse"]);
  press("vr");
  assert.deepEqual([entered, actions()], [[0], ["vr", "mouse"]]);
  guide.chosen(state("play", 0), 0);
  assert.equal(line(), "play.manner.own-way.first");
});
