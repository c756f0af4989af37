import assert from "node:assert/strict";
import { test } from "node:test";
import { COLUMNS, columnsOf, csv, sorted } from "../src/report/columns.js";
import { panelsOf } from "../src/report/learning-panels.js";
import { firstPoint, forcesArePhysical, headlineLevel, scalar, successUnderAttack, worstAt, worstOfAll } from "../src/report/measures.js";
import { readPayload, type Payload } from "../src/report/payload.js";

type Raw = Record<string, unknown>;

function point(id: string, naturalness: number | null, adversarialness: number | null, more: Raw = {}): Raw {
  return { id, seed: 0, naturalness, adversarialness, success: 0.5, ...more };
}

function payloadOf(points: readonly Raw[], more: Raw = {}): Payload {
  return readPayload({ frontier: { points, canonical: { success: 0.9 }, ...more } });
}

test("anything at all can be read: what is missing is null", () => {
  for (const junk of [null, 3, "x", [], {}, { frontier: [], replays: 1, scene: "no", band: { x: [1] } }]) {
    const payload = readPayload(junk);
    assert.deepEqual(payload.points, []);
    assert.equal(payload.band, null);
    assert.equal(payload.lacking, null);
    assert.equal(worstOfAll(payload, "0.9"), null);
    assert.equal(payload.replays.stored, false);
    assert.equal(firstPoint(payload), null);
    assert.equal(worstAt(payload, "0.9").value, null);
    assert.equal(successUnderAttack(payload, 0.9), null);
  }
});

test("λ reads as a number or infinity, and never as text", () => {
  const lambdas = [0, "inf", "0.1", null].map((lambda) => point("p", 0, 0, { lambda }));
  assert.deepEqual(payloadOf(lambdas).points.map((p) => p.lambda), [0, Infinity, null, null]);
});

test("a name from Object's prototype is no replay", () => {
  const payload = readPayload({ replays: { a: {} } });
  assert.equal(payload.replays.point("constructor", "worst"), null);
  assert.equal(payload.replays.canonical(0), null);
});

test("the page opens on the most adversarial human at naturalness ≥ 0.8", () => {
  const payload = payloadOf([point("wild", 0.7, 1), point("mild", 0.95, 0.2), point("worst", 0.8, 0.6), point("unknown", null, 1)]);
  assert.equal(firstPoint(payload)?.id, "worst");
});

test("it opens on one who is helped less often than in canonical play, where one is half as natural", () => {
  const helped = point("helped", 0.9, 0.3, { success: 0.9 });
  const hurt = point("hurt", 0.5, 0.25);
  assert.equal(firstPoint(payloadOf([helped, hurt, point("less", 0.6, 0.1), point("wild", 0.49, 1)]))?.id, "hurt");
  assert.equal(firstPoint(payloadOf([helped, hurt, point("natural", 0.8, 0.1)]))?.id, "natural");
});

test("where nobody fails so, or the task tells no success, it opens on the worst natural human", () => {
  const helped = [point("mild", 0.95, 0.2, { success: 0.9 }), point("worst", 0.9, 0.3, { success: 1 })];
  assert.equal(firstPoint(payloadOf([...helped, point("wild", 0.1, 1)]))?.id, "worst");
  const untold = [point("worst", 0.9, 0.3, { success: null }), point("wild", 0.6, 1, { success: null })];
  assert.equal(firstPoint(payloadOf(untold, { canonical: { success: null } }))?.id, "worst");
});

test("where none is that natural it opens on the most natural", () => {
  assert.equal(firstPoint(payloadOf([point("a", 0.2, 1), point("b", 0.7, 0.1)]))?.id, "b");
});

test("success under attack is the mean over seeds, canonical where a seed found none", () => {
  const payload = payloadOf([
    point("a", 0.95, 0.5, { success: 0.3 }), point("b", 0.99, 0.1, { success: 0.8 }),
    point("c", 0.5, 0.9, { seed: 1, success: 0 }),
  ]);
  assert.ok(Math.abs((successUnderAttack(payload, 0.9) ?? NaN) - (0.3 + 0.9) / 2) < 1e-12);
});

test("a human with more than 1 % of faulted episodes neither opens the page nor speaks for its seed", () => {
  const points = [
    point("faulted", 0.95, 0.9, { success: 0, faults: 3, episodes: 200 }),
    point("sound", 0.95, 0.5, { success: 0.3, faults: 2, episodes: 200 }),
  ];
  assert.equal(firstPoint(payloadOf(points))?.id, "sound");
  assert.equal(successUnderAttack(payloadOf(points), 0.9), 0.3);
});

test("a headline without an interval has none, not one made of nulls", () => {
  const payload = payloadOf([], { auc: 0.6, auc_interval: [null, 0.7], worst_at: { "0.9": 0.4 }, worst_at_interval: { "0.9": [0.3, 0.5] } });
  assert.deepEqual(scalar(payload, "auc"), { value: 0.6, interval: null });
  assert.deepEqual(worstAt(payload, "0.9"), { value: 0.4, interval: [0.3, 0.5] });
});

test("beside the mean over seeds stands the worst of them, where there are several", () => {
  const worst = (bySeed: Raw) => worstOfAll(payloadOf([], { worst_at_by_seed: { "0.9": bySeed } }), "0.9");
  assert.equal(worst({ 0: 0.04, 1: 0.13, 2: null }), 0.13);
  assert.equal(worst({ 0: 0.04 }), null);
});

test("where canonical play stands for a human, the words are those of the measurement", () => {
  assert.equal(readPayload({ lacking: "0 of 6 seeds" }).lacking, "0 of 6 seeds");
  assert.equal(readPayload({ lacking: ["0"] }).lacking, null);
});

test("forces count as physical only under the datasheet's servo", () => {
  assert.equal(forcesArePhysical({}), false);
  assert.equal(forcesArePhysical({ task: { servo: "paper" } }), false);
  assert.equal(forcesArePhysical({ task: { parameters: { servo: "datasheet" } } }), true);
});

test("the headline level is the one that equals naturalness everywhere", () => {
  const levels = (a: number, b: number): Raw => ({ naturalness_all: { step_k1: a, step_k4: b } });
  assert.equal(headlineLevel(payloadOf([point("a", 0.7, 0, levels(0.5, 0.7)), point("b", 0.5, 0, levels(0.5, 0.5))])), "step_k4");
  assert.equal(headlineLevel(payloadOf([point("a", 0.7, 0, levels(0.5, 0.6))])), null);
});

const column = (name: string) => COLUMNS.find((c) => c.name === name)!;

test("a column sorts by value, unknown last in both directions", () => {
  const { points } = payloadOf([point("a", null, 0), point("b", 0.1, 0), point("c", 0.9, 0)]);
  const ids = (descending: boolean) => sorted(points, column("naturalness"), descending).map((p) => p.id);
  assert.deepEqual(ids(true), ["c", "b", "a"]);
  assert.deepEqual(ids(false), ["b", "c", "a"]);
});

test("λ sorts with infinity last, ids by the numbers in them", () => {
  const { points } = payloadOf([point("s0-l10", 0, 0, { lambda: "inf" }), point("s0-l2", 0, 0, { lambda: 3 })]);
  assert.deepEqual(sorted(points, column("λ"), false).map((p) => p.id), ["s0-l2", "s0-l10"]);
  assert.deepEqual(sorted(points, column("human"), false).map((p) => p.id), ["s0-l2", "s0-l10"]);
});

test("regret has a column only where somebody asked whose fault it was", () => {
  const names = (more: Raw) => columnsOf(payloadOf([point("a", 0.5, 0.5, more)]).points).map((c) => c.name);
  assert.ok(!names({}).includes("regret"));
  assert.ok(names({ regret: 0.2 }).includes("regret"));
});

test("what is known of nobody has no column", () => {
  const names = (more: Raw) => columnsOf(payloadOf([point("a", 0.5, 0.5, more), point("b", 0.5, 0.5)]).points).map((c) => c.name);
  assert.ok(!names({}).includes("peak force [N]"));
  assert.ok(names({ peak_force: 3 }).includes("peak force [N]"));
});

test("the CSV has every field of every point, nested ones by dotted names", () => {
  const { points } = payloadOf([{ id: "a", outcomes: { helped: 0.5 }, lambda: "inf" }, { id: "b", extra: [1, 2] }]);
  assert.equal(csv(points), 'id,outcomes.helped,lambda,extra\r\na,0.5,inf,\r\nb,,,"[1,2]"\r\n');
});

test("a foreign text cannot be a formula, nor break out of its cell", () => {
  const { points } = payloadOf([{ id: '=HYPERLINK("x")', note: 'a,"b"\nc', loss: -1 }]);
  assert.equal(csv(points), 'id,note,loss\r\n"\'=HYPERLINK(""x"")","a,""b""\nc",-1\r\n');
});

test("curves that were not recorded have no panel", () => {
  const panels = panelsOf({ iteration: [1, 2], return: [3, 4], entropy: [null, null], score_canonical: [0] });
  assert.deepEqual(panels.map((panel) => panel.title), ["Return of the robot"]);
  assert.deepEqual(panelsOf({ iteration: [1] }), []);
});
