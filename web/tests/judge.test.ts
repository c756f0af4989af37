import assert from "node:assert/strict";
import { test } from "node:test";
import { answerOfKey, itemsOf, readQuestionnaire, unanswered } from "../src/study/judge/questionnaire.js";

const trial = { id: "t04", position: 4, of: 32, left: "a1", right: "b2" };

test("a stage is read with the trials that are left, in their order", () => {
  const found = readQuestionnaire({
    kind: "judge", index: 2, question: "naturalness", show: "replay",
    trials: [{ ...trial, reference: "c3" }, { ...trial, id: "t05", position: 5, reference: "c3" }],
  });
  assert.equal(found?.index, 2);
  assert.deepEqual(found?.trials.map(({ id, reference }) => [id, reference]), [["t04", "c3"], ["t05", "c3"]]);
});

test("danger has no reference", () => {
  const found = readQuestionnaire({ kind: "judge", index: 0, question: "danger", show: "replay", trials: [trial] });
  assert.deepEqual(found?.trials, [{ ...trial, reference: null }]);
});

test("another stage, or a question that nobody knows, is no questionnaire", () => {
  for (const stage of [{ kind: "watch" }, { kind: "judge", question: "taste" }, { kind: "judge", question: "constructor" }]) {
    assert.equal(readQuestionnaire(stage), null);
  }
});

test("scales are asked one after the other, A before B, under the server's names", () => {
  const names = (question: "correspondence" | "danger" | "naturalness"): string[] => itemsOf(question).map(({ name }) => name);
  assert.deepEqual(names("danger"), ["goal-left", "goal-right", "danger-left", "danger-right"]);
  assert.deepEqual(names("naturalness"), ["naturalness-left", "naturalness-right"]);
  assert.deepEqual(names("correspondence"), ["correspondence"]);
});

test("zero is an answer", () => {
  assert.deepEqual(unanswered("naturalness", { "naturalness-left": 0 }), ["naturalness-right"]);
  assert.deepEqual(unanswered("correspondence", { correspondence: "left" }), []);
});

test("digits answer scales, letters choose, and no key does both", () => {
  assert.deepEqual(["0", "7", "8", "a", "Enter"].map((key) => answerOfKey("danger", key)), [0, 7, null, null, null]);
  assert.deepEqual(["a", "B", "1", "c", "Enter"].map((key) => answerOfKey("correspondence", key)), ["left", "right", null, null, null]);
});
