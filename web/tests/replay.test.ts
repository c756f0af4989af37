import assert from "node:assert/strict";
import { test } from "node:test";
import { decodePoses, readClip, readScene, type Clip, type Geom } from "../src/replay/clip.js";
import { bodyPose, carry, pathOf, poseAt, rotate, tellingFrame, tipOf } from "../src/replay/pose.js";
import { surfaceDistance, touchedGeom } from "../src/replay/touch.js";

const close = (actual: readonly number[], expected: readonly number[]): void => {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => assert.ok(Math.abs(value - (expected[i] ?? NaN)) < 1e-3, `${actual} is not ${expected}`));
};

/** A clip of one body (index 1) from [frame][x, y, z, w, qx, qy, qz]. */
function clipOf(frames: readonly (readonly number[])[], more: Partial<Clip> = {}): Clip {
  return {
    seed: 1, dt: 0.1, frames: frames.length, bodies: [1], poses: Float32Array.from(frames.flat()), itch: null,
    forceUnwanted: [], forceItch: [], distance: [], counted: [], contacts: [], return: 0, success: true,
    outcome: "helped", failure: null, ...more,
  };
}

const STILL = [1, 0, 0, 0];
const QUARTER = [Math.SQRT1_2, 0, 0, Math.SQRT1_2]; // A quarter turn about z.

test("poses decode as Python encodes them", () => {
  // The doctest of rigid.report.encode_poses.
  close([...(decodePoses("AQAAAAAA/38AAAAAAAA=", 7) ?? [])], [1e-4, 0, 0, 1, 0, 0, 0]);
});

test("poses of another length, or no base64, are refused", () => {
  assert.equal(decodePoses("AQAAAAAA/38AAAAAAAA=", 14), null);
  assert.equal(decodePoses("<script>", 7), null);
});

test("a damaged clip reads as none stored", () => {
  assert.equal(readClip({ frames: 2, bodies: [1], poses: "AQAAAAAA/38AAAAAAAA=" }), null);
  assert.equal(readClip(null), null);
  assert.equal(readScene({ geoms: "none" }), null);
});

test("a scene names what the tool is to reach, by default the itch", () => {
  assert.equal(readScene({ geoms: [{}], goal: "mouth" })?.goal, "mouth");
  assert.equal(readScene({ geoms: [{}] })?.goal, "itch");
});

test("a clip says what went wrong and when, else nothing", () => {
  const clip = { frames: 1, bodies: [1], poses: "AQAAAAAA/38AAAAAAAA=" };
  const failure = { kind: "stuck", part: null, frame: 7, time: 0.7, says: "it stood still" };
  assert.deepEqual(readClip({ ...clip, failure })?.failure, { frame: 7, says: "it stood still" });
  for (const unknown of [null, 3, "x", {}, { says: "no moment" }]) assert.equal(readClip({ ...clip, failure: unknown })?.failure, null);
});

test("contacts that name the bodies read as those that do not", () => {
  const contacts = [[4, 1, 2, 3, 5, 2, 9, 11], [4, 1, 2, 3, 5, 2]];
  const read = readClip({ frames: 1, bodies: [1], poses: "AQAAAAAA/38AAAAAAAA=", contacts })?.contacts;
  assert.deepEqual(read?.[0], { frame: 4, at: [1, 2, 3], force: 5, kind: "unwanted" });
  assert.deepEqual(read?.[1], read?.[0]);
});

test("between frames positions are linear", () => {
  const clip = clipOf([[0, 0, 0, ...STILL], [1, 2, 4, ...STILL]]);
  close(poseAt(clip, 0, 0.25).position, [0.25, 0.5, 1]);
});

test("a rotation takes the shorter way, whatever the sign of the quaternion", () => {
  const negated = QUARTER.map((v) => -v);
  const clip = clipOf([[0, 0, 0, ...STILL], [0, 0, 0, ...negated]]);
  const eighth = Math.PI / 8;
  close(poseAt(clip, 0, 0.5).rotation, [Math.cos(eighth), 0, 0, Math.sin(eighth)]);
});

test("time beyond the episode shows its end", () => {
  const clip = clipOf([[0, 0, 0, ...STILL], [1, 0, 0, ...STILL]]);
  close(poseAt(clip, 0, 99).position, [1, 0, 0]);
});

test("a quarter turn about z takes x to y", () => {
  close(rotate(QUARTER as never, [1, 0, 0]), [0, 1, 0]);
  close(carry({ position: [1, 1, 1], rotation: QUARTER as never }, [1, 0, 0]), [1, 2, 1]);
});

test("a body that no episode moves stands where the scene says, else at the origin", () => {
  const scene = readScene({ bodies: ["world", "base", "post"], geoms: [{}], rest: [null, [1, 2, 3, ...QUARTER]] });
  assert.ok(scene);
  const clip = clipOf([[9, 9, 9, ...STILL]], { bodies: [4] });
  close(bodyPose(scene, clip, 1, 0).position, [1, 2, 3]);
  close(bodyPose(scene, clip, 1, 0).rotation, QUARTER);
  close(bodyPose(scene, clip, 2, 0).position, [0, 0, 0]);
  close(bodyPose(scene, clip, 4, 0).position, [9, 9, 9]);
});

test("the path of a point on a body that stands still is unknown", () => {
  const clip = clipOf([[0, 0, 0, ...STILL]]);
  assert.equal(pathOf(clip, 7, [0, 0, 0]), null);
  close(pathOf(clip, 1, [0, 0, 1])?.[0] ?? [], [0, 0, 1]);
});

const geom = (over: Partial<Geom>): Geom => ({
  name: "", body: 1, type: "capsule", size: [0.1, 0.5], pos: [0, 0, 0], quat: [1, 0, 0, 0],
  rgba: [1, 1, 1, 1], role: "human", ...over,
});

test("the tip is the body of that name, else the geom", () => {
  assert.deepEqual(tipOf({ bodies: ["world", "tool_tip"], geoms: [], rest: [], goal: "itch" }), { body: 1, point: [0, 0, 0] });
  for (const name of ["tip", "scratcher_tip"]) {
    const tip = geom({ name, body: 3, pos: [0, 0, 2] });
    assert.deepEqual(tipOf({ bodies: ["world"], geoms: [tip], rest: [], goal: "itch" }), { body: 3, point: [0, 0, 2] });
  }
  assert.equal(tipOf({ bodies: ["world"], geoms: [geom({ name: "multip" })], rest: [], goal: "itch" }), null);
});

test("distance to a capsule counts from its side and from its round end", () => {
  assert.ok(Math.abs(surfaceDistance(geom({}), [0.3, 0, 0.2]) - 0.2) < 1e-9);
  assert.ok(Math.abs(surfaceDistance(geom({}), [0, 0, 0.8]) - 0.2) < 1e-9);
  assert.ok(surfaceDistance(geom({}), [0, 0, 0]) < 0);
});

test("a contact belongs to the nearest limb, where that limb is at that moment", () => {
  const scene = { bodies: [], geoms: [geom({ role: "robot" }), geom({ body: 0, pos: [5, 0, 0] }), geom({})], rest: [], goal: "itch" };
  const clip = clipOf([[0, 0, 0, ...STILL], [3, 0, 0, ...STILL]]);
  const at = (frame: number, x: number): number =>
    touchedGeom(scene, clip, { frame, at: [x, 0, 0], force: 1, kind: "unwanted" });
  assert.equal(at(0, 0.1), 2);
  assert.equal(at(0, 4.5), 1);
  assert.equal(at(1, 3.2), 2);
});

test("a scene without people has no touched limb", () => {
  const scene = { bodies: [], geoms: [geom({ role: "robot" })], rest: [], goal: "itch" };
  const contact = { frame: 0, at: [0, 0, 0], force: 1, kind: "unwanted" } as const;
  assert.equal(touchedGeom(scene, clipOf([[0, 0, 0, ...STILL]]), contact), -1);
});

test("the page opens on what it says went wrong", () => {
  const frames = [0, 1, 2].map(() => [0, 0, 0, ...STILL]);
  const touched = { forceUnwanted: [9, 0, 0], failure: { frame: 2, says: "robot stuck" } };
  assert.equal(tellingFrame(clipOf(frames, touched)), 2);
  assert.equal(tellingFrame(clipOf(frames, { failure: { frame: 7, says: "beyond" } })), 2);
});

test("where nothing is said the page opens on the hardest unwanted contact, else on the closest approach", () => {
  const frames = [0, 1, 2].map(() => [0, 0, 0, ...STILL]);
  assert.equal(tellingFrame(clipOf(frames, { forceUnwanted: [0, 9, 3], distance: [3, 2, 1] })), 1);
  assert.equal(tellingFrame(clipOf(frames, { forceUnwanted: [0, 0, 0], distance: [3, 1, 2] })), 1);
  assert.equal(tellingFrame(clipOf(frames)), 0);
});
