import assert from "node:assert/strict";
import { test } from "node:test";
import { count, duration, fixed, general, intervalText, lambdaText, percent } from "../src/base/format.js";
import { lambdaRange, lambdaShare } from "../src/chart/palette.js";
import { lambdaAxis, roundsOf } from "../src/chart/sweep.js";
import { levelText, rangeSource } from "../src/report/words.js";

test("unknown is a dash, never zero", () => {
  for (const unknown of [null, undefined, NaN, Infinity]) assert.equal(fixed(unknown), "—");
  assert.equal(percent(null), "—");
  assert.equal(count(null), "—");
  assert.equal(duration(null), "—");
  assert.equal(intervalText(null), null);
});

test("numbers have a real minus, and minus zero none", () => {
  assert.equal(fixed(-32.16, 1), "−32.2");
  assert.equal(fixed(-0.001), "0.00");
});

test("numbers of any size are short", () => {
  const texts = [-270, 450, -2.5, 0.025, 0, 1.25e7, null].map(general);
  assert.deepEqual(texts, ["−270", "450", "−2.5", "0.025", "0", "1.3·10⁷", "—"]);
});

test("the source of the range is spelt out, with the file of a calibrated one", () => {
  assert.equal(rangeSource({ range_source: "task" }), "the task's range");
  assert.equal(rangeSource({ range_source: "option" }), "a range given by the user");
  const file = { name: "range.json", sha256: "0123456789abcdef" };
  assert.equal(rangeSource({ range_source: "calibrated", range_file: file }), "calibrated range, range.json 01234567");
  assert.equal(rangeSource({ range_source: 7 }), "range: 7");
  assert.equal(rangeSource({}), "range: source unknown");
});

test("λ is short over its whole range", () => {
  const texts = [0, 1e-8, 0.0178, 0.01, 1, 3.2, 100, Infinity, null].map(lambdaText);
  assert.deepEqual(texts, ["0", "1·10⁻⁸", "0.0178", "0.01", "1", "3.2", "100", "∞", "—"]);
});

test("counts are grouped", () => {
  assert.equal(count(31104000), "31\u202f104\u202f000");
});

test("times are said in the unit people use", () => {
  assert.deepEqual([42, 1200, 7200].map(duration), ["42 s", "20 min", "2.0 h"]);
});

test("levels of the referee are spelt out, unknown names kept", () => {
  assert.equal(levelText("step_k4"), "single steps, κ = 4");
  assert.equal(levelText("window16_k1"), "16-step windows, κ = 1");
  assert.equal(levelText("<b>"), "<b>");
});

test("colours of λ are ordered, with 0 and ∞ at the ends", () => {
  const range = lambdaRange([0, 0.01, 10, Infinity, null]);
  assert.deepEqual(range, [0.01, 10]);
  const shares = [0, 0.01, 0.1, 1, 10, Infinity].map((v) => lambdaShare(v, range));
  assert.deepEqual(shares, [...shares].sort((a, b) => a - b));
  assert.equal(shares[0], 0);
  assert.equal(shares.at(-1), 1);
});

test("one λ alone has a colour", () => {
  assert.equal(lambdaShare(1, lambdaRange([1])), 0.5);
  assert.equal(lambdaShare(0, lambdaRange([0])), 0);
});

test("the λ axis keeps 0 and ∞ apart from the decades", () => {
  const axis = lambdaAxis([0, 0.01, 1, Infinity], 0, 400);
  const places = [0, 0.01, 0.1, 1, Infinity].map(axis.place);
  assert.deepEqual(places, [...places].sort((a, b) => a - b));
  assert.deepEqual(axis.ticks, [0, 0.01, 0.1, 1, Infinity]);
  assert.equal(axis.breaks.length, 2);
});

test("a λ axis without finite values still places its ends", () => {
  const axis = lambdaAxis([0, Infinity], 0, 400);
  assert.ok(axis.place(0) < axis.place(Infinity));
  assert.deepEqual(axis.ticks, [0, Infinity]);
});

test("rounds come ascending, unknown ones left out", () => {
  assert.deepEqual(roundsOf([{ round: 3 }, { round: 1 }, { round: null }, { round: 3 }]), [1, 3]);
});
