import assert from "node:assert/strict";
import { test } from "node:test";
import { readClip, readScene } from "../src/replay/clip.js";
import { viewpointFor } from "../src/replay/viewpoint.js";

/** A trunk at the origin with legs towards `front`, a robot at `robot`; nothing moves. */
function lookAt(front: readonly [number, number], robot: readonly [number, number]) {
  const geom = (role: string, x: number, y: number, z: number) => ({ type: "sphere", size: [0.1], pos: [x, y, z], role });
  const scene = readScene({
    bodies: ["world"],
    geoms: [geom("human", 0, 0, 1), geom("human", ...front, 0.4), geom("robot", ...robot, 0.6)],
  });
  const clip = readClip({ frames: 1, bodies: [], poses: "" });
  assert.ok(scene && clip);
  const { position, target } = viewpointFor(scene, clip);
  return position.sub(target);
}

test("the person is seen from the side they face, whichever side the robot is on", () => {
  for (const x of [-1, 1]) {
    assert.ok(lookAt([0, -0.5], [x, 0]).y < 0);
    assert.ok(lookAt([0, 0.5], [x, 0]).y > 0);
  }
});

test("the view is from above and never at an undefined place", () => {
  assert.ok(lookAt([0, -0.5], [-1, 0]).z > 0);
  for (const v of lookAt([0, 0], [0, 0]).toArray()) assert.ok(Number.isFinite(v));
});
