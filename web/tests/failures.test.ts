import assert from "node:assert/strict";
import { test } from "node:test";
import { readFailures } from "../src/report/failures.js";
import { readPayload } from "../src/report/payload.js";

type Raw = Record<string, unknown>;

const example: Raw = { id: "s0-r1-l4", episode: "median", naturalness: 0.7, frame: 21, time: 2.1, says: "it lost the itch" };

function mode(more: Raw = {}): Raw {
  return {
    kind: "unwanted_contact", part: "head", title: "Unwanted contact: head", meaning: "It hurts.",
    points: ["s0-r1-l4", "s0-r1-l1"], naturalness: [0.1, 0.7], share: 0.2, example, ...more,
  };
}

function read(modes: readonly unknown[]) {
  return readFailures({ humans: 8, modes, unseen: 0.1 });
}

test("modes keep the order of the file, their humans and their example", () => {
  const found = read([mode(), mode({ kind: "stuck", title: "The robot is stuck" })]);
  assert.deepEqual(found?.modes.map(({ title, unwanted }) => [title, unwanted]), [["Unwanted contact: head", true], ["The robot is stuck", false]]);
  assert.deepEqual(found?.modes[0]?.ids, ["s0-r1-l4", "s0-r1-l1"]);
  assert.deepEqual(found?.modes[0]?.naturalness, [0.1, 0.7]);
  assert.deepEqual(found?.modes[0]?.example, {
    id: "s0-r1-l4", which: "median", naturalness: 0.7, frame: 21, time: 2.1, says: "it lost the itch",
  });
  assert.deepEqual([found?.humans, found?.unseen], [8, 0.1]);
});

test("no modes are told from nothing known", () => {
  assert.deepEqual(read([])?.modes, []);
  assert.equal(readPayload({}).failures, null);
  assert.equal(readPayload({ failures: null }).failures, null);
});

test("anything at all can be read: a mode without an example to watch is none", () => {
  for (const junk of [null, 3, "x", [], {}, { modes: "many" }]) assert.equal(readFailures(junk), null);
  for (const junk of [null, 3, [], mode({ example: null }), mode({ example: { ...example, id: 3 } }), mode({ example: { ...example, frame: "x" } })]) {
    assert.deepEqual(read([junk])?.modes, []);
  }
  const odd = read([mode({ points: ["a", 3, null], naturalness: ["x"], share: "much", title: 7, example: { ...example, episode: "best" } })])?.modes[0];
  assert.deepEqual([odd?.ids, odd?.naturalness, odd?.share, odd?.title, odd?.example.which], [["a"], null, null, "7", "worst"]);
});
