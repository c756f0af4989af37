import assert from "node:assert/strict";
import { test } from "node:test";
import { windowOf, type Posture } from "../src/chart/postures.js";
import { readClip, readScene, type Geom, type Vector } from "../src/replay/clip.js";
import { appear, outlineOf, pictureFrom } from "../src/replay/outline.js";
import { readDiscriminators } from "../src/report/discriminators.js";

type Raw = Record<string, unknown>;

const close = (actual: readonly number[], expected: readonly number[]): void => {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => assert.ok(Math.abs(value - (expected[i] ?? NaN)) < 1e-9, `${actual} is not ${expected}`));
};

function judged(more: Raw = {}): Raw {
  const accuracy = { canonical: [1, 0.5], adversaries: { a: 0.25, b: null } };
  return { discriminator: accuracy, referee: accuracy, scores: { noisy: [[-1], [1]], own: [0.5] }, ...more };
}

function read(more: Raw = {}) {
  return readDiscriminators({ 0: { levels: [0, 1], canonical_episodes: 40, judged: { a: judged() }, ...more } }).get("0");
}

test("shares come by human and by level, an unknown one as NaN", () => {
  const found = read()?.judged?.get("a");
  assert.deepEqual(found?.discriminator.canonical, [1, 0.5]);
  assert.deepEqual([...(found?.referee?.adversaries ?? [])], [["a", 0.25], ["b", NaN]]);
  assert.deepEqual(found?.scores, { noisy: [[-1], [1]], own: [0.5] });
  assert.equal(read()?.canonicalEpisodes, 40);
  assert.equal(read()?.adversaryEpisodes, null);
});

test("a measure without a discriminator is told from a run that examined none", () => {
  assert.equal(read({ judged: null })?.judged, null);
  assert.equal(readDiscriminators(undefined).size, 0);
});

test("anything at all can be read: what does not fit is unknown", () => {
  for (const junk of [null, 3, "x", [], { 0: null }, { 0: { levels: "many" } }, { 0: { levels: [0] } }]) {
    assert.equal(readDiscriminators(junk).size, 0);
  }
  for (const levels of [[1, 0], [0, null], [-1, 0], [0, 0]]) assert.equal(read({ levels }), undefined);
  assert.equal(read({ judged: "x" })?.judged?.size, 0);
  assert.equal(read({ judged: { a: judged({ discriminator: { canonical: [1] } }) } })?.judged?.size, 0);
  assert.equal(read({ judged: { a: judged({ referee: [] }) } })?.judged?.get("a")?.referee, null);
  assert.deepEqual(read({ judged: { a: judged({ scores: 7 }) } })?.judged?.get("a")?.scores, { noisy: [], own: [] });
});

test("a name from Object's prototype is no human and no seed", () => {
  assert.equal(read()?.judged?.get("constructor"), undefined);
  assert.equal(readDiscriminators({}).get("constructor"), undefined);
});

test("poses that are damaged are none", () => {
  const clip = { frames: 1, bodies: [1], poses: "AQAAAAAA/38AAAAAAAA=" };
  const poses = { levels: [0], noisy: clip, own: { a: clip, b: { ...clip, frames: 2 } } };
  assert.deepEqual([...(read({ poses })?.poses?.own.keys() ?? [])], ["a"]);
  assert.equal(read({ poses: { ...poses, noisy: { ...clip, poses: "<script>" } } })?.poses, null);
  assert.equal(read({ poses: null })?.poses, null);
});

test("a picture is upright and square on to where it is seen from", () => {
  for (const eye of [[0, -1, 0], [-1, -2, 1], [3, 0.5, -1]] as Vector[]) {
    const { right, down } = pictureFrom(eye);
    const dot = (a: Vector, b: Vector): number => a.reduce((sum, value, i) => sum + value * (b[i] ?? 0), 0);
    close([dot(right, right), dot(down, down), dot(right, down), dot(right, eye), dot(down, eye)], [1, 1, 0, 0, 0]);
    assert.ok(appear({ right, down }, [0, 0, 1])[1] < 0);
  }
  close([...appear(pictureFrom([0, -1, 0]), [2, 5, 3])], [2, -3]);
});

const FRONT = pictureFrom([0, -1, 0]);
const STILL = { position: [1, 0, 0], rotation: [1, 0, 0, 0] } as const;
const geom = (over: Partial<Geom>): Geom => ({
  name: "", body: 1, type: "capsule", size: [0.1, 0.5], pos: [0, 0, 0], quat: [1, 0, 0, 0],
  rgba: [1, 1, 1, 1], role: "human", ...over,
});

test("a capsule is a thick line between its ends, a sphere one of no length", () => {
  assert.deepEqual(outlineOf(geom({}), STILL, FRONT), { kind: "limb", from: [1, 0.5], to: [1, -0.5], radius: 0.1 });
  assert.deepEqual(outlineOf(geom({ type: "sphere" }), STILL, FRONT), { kind: "limb", from: [1, 0], to: [1, 0], radius: 0.1 });
});

test("an ellipsoid is the ellipse of its shadow, however it is turned", () => {
  const eighth = Math.PI / 8; // An eighth turn about y: both horizontal axes are seen askew.
  const turned = geom({ type: "ellipsoid", size: [3, 1, 1], quat: [Math.cos(eighth), 0, Math.sin(eighth), 0] });
  const outline = outlineOf(turned, STILL, FRONT);
  assert.ok(outline?.kind === "ellipse");
  const [a, b, c, d] = outline.matrix;
  close([a * a + c * c, b * b + d * d, a * b + c * d], [5, 5, 4]);
});

test("shapes with edges are left out", () => {
  for (const type of ["box", "cylinder", "mesh"]) assert.equal(outlineOf(geom({ type }), STILL, FRONT), null);
});

test("the window holds every arm", () => {
  const still = [0, 0, 0, 0, 0, 0, 255, 127, 0, 0, 0, 0, 0, 0]; // Of one body, as bytes.
  const poses = btoa(String.fromCharCode(...still, ...still));
  const clip = readClip({ frames: 1, bodies: [2, 1], poses });
  const scene = readScene({ bodies: ["world", "fore", "upper"], geoms: [{ body: 1, type: "sphere", size: [0.5], pos: [0, 0, 2], role: "human" }] });
  assert.ok(clip && scene);
  const posture: Posture = { clip, frame: 0, score: -1 };
  const { x, y, width, height } = windowOf(scene, [posture], FRONT);
  assert.ok(x < -0.49 && x + width > 0.5 && y < -2.5 && y + height > -1.5);
});
