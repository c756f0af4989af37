import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vector } from "../src/replay/clip.js";
import { poseAt } from "../src/replay/pose.js";
import { readState } from "../src/study/api.js";
import { readFrame, type Frame } from "../src/study/play/frame.js";
import { LiveClip } from "../src/study/play/live-clip.js";
import { Pacer } from "../src/study/play/pacer.js";
import { dragged, keyed, metresPerPixel, pushed, reachable, type Sight } from "../src/study/play/target.js";
import { Live, readBegun } from "../src/study/play/live.js";
import { wordsOf } from "../src/study/words.js";
import { placed, placementFor, shoulderOf, sideOf } from "../src/study/xr/placing.js";

const close = (actual: readonly number[], expected: readonly number[], within = 1e-3): void => {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => assert.ok(Math.abs(value - (expected[i] ?? NaN)) < within, `${actual} is not ${expected}`));
};

/** A message of one body whose x is given for each substep, in units of 1e-4 m. */
function message(step: number, xs: readonly number[], flags = 0): ArrayBuffer {
  const view = new DataView(new ArrayBuffer(24 + 14 * xs.length));
  view.setUint32(0, step, true);
  view.setUint8(4, flags);
  view.setUint8(5, xs.length);
  view.setUint16(6, 1, true);
  view.setUint16(8, 7, true);
  [0.5, -0.25, 1].forEach((value, i) => view.setFloat32(12 + 4 * i, value, true));
  xs.forEach((x, i) => {
    view.setInt16(24 + 14 * i, x, true);
    view.setInt16(24 + 14 * i + 6, 32767, true);
  });
  return view.buffer as ArrayBuffer;
}

const frame = (step: number, xs: readonly number[]): Frame => {
  const read = readFrame(message(step, xs));
  assert.ok(read);
  return read;
};

test("a frame reads as the server wrote it", () => {
  const read = readFrame(message(3, [10000, -20000], 3));
  assert.ok(read);
  assert.deepEqual([read.step, read.unwanted, read.done, read.substeps, read.bodies, read.counted], [3, true, true, 2, 1, 7]);
  close(read.hand, [0.5, -0.25, 1]);
  close([...read.poses], [1, 0, 0, 1, 0, 0, 0, -2, 0, 0, 1, 0, 0, 0]);
});

test("a frame that is cut, too long or empty is none", () => {
  const whole = message(0, [1]);
  assert.equal(readFrame(whole.slice(0, 20)), null);
  assert.equal(readFrame(whole.slice(0, -2)), null);
  assert.equal(readFrame(message(0, [])), null);
  assert.equal(readFrame(new ArrayBuffer(0)), null);
});

const settings = { bodies: [4], substeps: 2, period: 0.1, horizon: 3, goal: null };
const xAt = (clip: LiveClip, time: number): number => poseAt(clip, 0, time).position[0];

test("a live clip grows by the substeps of each step and is seen between them", () => {
  const clip = new LiveClip(settings);
  assert.ok(clip.take(frame(0, [0])));
  assert.equal(clip.frames, 1);
  assert.ok(clip.take(frame(1, [10000, 20000])));
  assert.equal(clip.frames, 3);
  close([xAt(clip, 0), xAt(clip, 0.5), xAt(clip, 2)], [0, 0.5, 2]);
  close([xAt(clip, 99)], [2]);
});

test("steps that were left out are bridged in a straight line", () => {
  const clip = new LiveClip(settings);
  clip.take(frame(0, [0]));
  assert.ok(clip.take(frame(2, [3000, 4000])));
  close([1, 2, 3, 4].map((time) => xAt(clip, time)), [0.1, 0.2, 0.3, 0.4]);
});

test("frames of another episode, or from the past, change nothing", () => {
  const clip = new LiveClip(settings);
  clip.take(frame(0, [0]));
  clip.take(frame(1, [1, 2]));
  assert.equal(clip.take(frame(1, [5, 5])), false);
  assert.equal(clip.take(frame(2, [5, 5, 5])), false);
  assert.equal(clip.take(frame(9, [5, 5])), false);
  assert.equal(clip.frames, 3);
});

test("with even arrivals the picture is one step behind and moves evenly", () => {
  const pacer = new Pacer(0.1);
  const shown: number[] = [];
  for (let ms = 0; ms <= 1000; ms += 20) {
    if (ms % 100 === 0) pacer.arrived(ms / 100, 5 + ms / 1000);
    shown.push(pacer.at(5 + ms / 1000));
  }
  close([shown.at(-1) ?? NaN], [9]);
  shown.slice(6).forEach((time, i) => close([time - (shown[i + 5] ?? NaN)], [0.2]));
});

test("a late step neither stops the picture for long nor makes it jump", () => {
  const pacer = new Pacer(0.1);
  const shown: number[] = [];
  for (let ms = 0; ms <= 4000; ms += 20) {
    const step = Math.floor(ms / 100);
    // Every other step comes 60 ms late.
    if (ms % 100 === (step % 2 ? 60 : 0)) pacer.arrived(step, ms / 1000);
    shown.push(pacer.at(ms / 1000));
  }
  const steps = shown.slice(1).map((time, i) => time - (shown[i] ?? NaN)).slice(100);
  assert.ok(Math.min(...steps) > 0.1, "it never stands still once it knows");
  assert.ok(Math.max(...steps) < 0.3, "it never jumps");
});

test("what is shown never goes back and never beyond what is there", () => {
  const pacer = new Pacer(0.1);
  assert.equal(pacer.at(1), 0);
  pacer.arrived(0, 1);
  pacer.arrived(1, 1.1);
  assert.equal(pacer.at(9), 1);
  pacer.arrived(2, 9.5);
  assert.ok(pacer.at(9.5) >= 1);
});

/** From 2 m along −y, looking along +y, z up; 90° of 200 px. */
const sight: Sight = {
  position: [0, -2, 0], right: [1, 0, 0], up: [0, 0, 1], forward: [0, 1, 0], angle: Math.PI / 2, height: 200,
};

test("a drag moves the target with the pointer, in the plane of the picture", () => {
  close([metresPerPixel(sight, [0, 0, 0])], [0.02]);
  close(dragged([0, 0, 0], sight, 10, -5), [0.2, 0, 0.1]);
});

test("the wheel moves the target along the line of sight, never behind the eye", () => {
  close(pushed([0, 0, 0], sight, 0.5), [0, 0.5, 0]);
  close(pushed([0, 0, 0], sight, -9), [0, -1.9, 0]);
});

test("keys move right, up and away as seen, however the camera tilts", () => {
  const tilted: Sight = { ...sight, up: [0, 0.6, 0.8], forward: [0, 0.8, -0.6] };
  close(keyed([0, 0, 0], tilted, ["ArrowRight"], 1), [0.45, 0, 0]);
  close(keyed([0, 0, 0], tilted, ["PageUp"], 1), [0, 0.45, 0]);
  close(keyed([0, 0, 0], tilted, ["KeyS"], 1), [0, 0, -0.45]);
  close(keyed([1, 2, 3], tilted, ["ArrowLeft", "KeyD"], 1), [1, 2, 3]);
});

test("two keys are no faster than one", () => {
  assert.ok(Math.abs(Math.hypot(...keyed([0, 0, 0], sight, ["KeyD", "KeyW"], 1)) - 0.45) < 1e-9);
});

test("a target out of reach becomes the nearest one in reach", () => {
  const reach = { shoulder: [1, 0, 0] as Vector, radius: 0.5 };
  close(reachable([3, 0, 0], reach), [1.5, 0, 0]);
  close(reachable([1.2, 0.1, 0], reach), [1.2, 0.1, 0]);
});

test("an episode without substeps, period or bodies does not begin", () => {
  const good = { number: 0, of: 2, bodies: [3], substeps: 5, period: 0.1, horizon: 100, reach: { shoulder: [0, 0, 1], radius: 0.6 }, hand: [1, 2, 3] };
  assert.deepEqual(readBegun(good)?.hand, [1, 2, 3]);
  for (const broken of [{ substeps: 0 }, { period: null }, { bodies: [] }, { horizon: "x" }]) {
    assert.equal(readBegun({ ...good, ...broken }), null);
  }
});

test("in a headset the stretched arm reaches as far as the person's, from the same shoulder", () => {
  const head = { position: [0.3, 1.2, 0.1] as Vector, forward: [1, -0.2, 0] as Vector };
  const reach = { shoulder: [-0.2, 0.05, 1] as Vector, radius: 0.6 };
  const shoulder = shoulderOf(head, 0.45, "right");
  const placement = placementFor(head, shoulder, 0.75, reach, [0, -1, 0]);
  close(placed(placement, shoulder), reach.shoulder);
  // Ahead of the participant, +x there, is where the person looks, −y here.
  close(placed(placement, [shoulder[0] + 0.75, shoulder[1], shoulder[2]]), [-0.2, 0.05 - 0.6, 1]);
  // Up stays up; their right is the person's right.
  close(placed(placement, [shoulder[0], shoulder[1] + 0.75, shoulder[2]]), [-0.2, 0.05, 1.6]);
  close(placed(placement, [shoulder[0], shoulder[1], shoulder[2] + 0.75]), [-0.8, 0.05, 1]);
});

test("the shoulder is below and beside the eyes, lower for who sits taller", () => {
  const head = { position: [0, 1.2, 0] as Vector, forward: [0, 0, -1] as Vector };
  const [x, y] = shoulderOf(head, 0.4, "right");
  close([x, y], [0.19, 1.2 - 0.245 * 0.8]);
  close([shoulderOf(head, null, "left")[0]], [-0.19]);
});

test("which arm it is depends on where the person looks", () => {
  assert.equal(sideOf([-0.2, 0, 0], [0, 0, 0], [0, -1, 0]), "right");
  assert.equal(sideOf([-0.2, 0, 0], [0, 0, 0], [0, 1, 0]), "left");
});

test("words fill in values, choose the number, and show a gap by its name", () => {
  const words = wordsOf({ a: { b: "{n} of {of}" }, s: { one: "{count} second", other: "{count} seconds" }, l: ["x", "y"] }, "en");
  assert.equal(words("a.b", { n: 1, of: 3 }), "1 of 3");
  assert.equal(words("s", { count: 1 }), "1 second");
  assert.equal(words("s", { count: 2 }), "2 seconds");
  assert.equal(words("a.c"), "a.c");
  assert.deepEqual(words.list("l"), ["x", "y"]);
  assert.deepEqual(words.list("a.b"), []);
});

test("a state of unknown shape is harmless", () => {
  const state = readState({ stages: [{ kind: "watch" }, 7], stage: [], participant: null });
  assert.deepEqual(state.stages, [{ kind: "watch", index: 0 }, { kind: "", index: 1 }]);
  assert.deepEqual(state.stage, {});
  assert.equal(state.language, "en");
});

test("a connection of which nothing is heard is given up, and opened anew", (t) => {
  t.mock.timers.enable({ apis: ["setInterval", "setTimeout"] });
  const opened: Silent[] = [];
  class Silent extends EventTarget {
    static readonly OPEN = 1;
    readonly readyState = 1;
    readonly sent: string[] = [];
    binaryType = "";
    isClosed = false;
    constructor() {
      super();
      opened.push(this);
    }
    send(message: string): void {
      this.sent.push(message);
    }
    close(): void {
      this.isClosed = true;
    }
  }
  Object.assign(globalThis, { WebSocket: Silent, window: globalThis });
  const told: string[] = [];
  const live = new Live("ws://study/live", {
    connected: () => told.push("connected"), lost: () => told.push("lost"), closed: () => told.push("closed"),
    begun: () => undefined, frame: () => undefined, finished: () => undefined, refused: () => undefined,
  });
  const [first] = opened as [Silent];
  first.dispatchEvent(new Event("open"));
  t.mock.timers.tick(6000);
  first.dispatchEvent(new MessageEvent("message", { data: '{"type": "pong", "sent": 0}' }));
  t.mock.timers.tick(9000);
  assert.deepEqual([told, first.isClosed], [["connected"], false]);
  t.mock.timers.tick(2000);
  assert.deepEqual([told, first.isClosed], [["connected", "lost"], true]);
  first.dispatchEvent(Object.assign(new Event("close"), { code: 1006 })); // Late: it is said once.
  t.mock.timers.tick(300);
  assert.deepEqual([told.length, opened.length], [2, 2]);
  live.dispose();
});

test("the steps count what comes before the stages", () => {
  assert.deepEqual(readState({ before: ["consent", "demographics"] }).before, ["consent", "demographics"]);
  assert.deepEqual(readState({}).before, []);
});
