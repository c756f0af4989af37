import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Vector3 } from "three";
import { readClip, readScene } from "../src/replay/clip.js";
import { FIELD_OF_VIEW, viewpointFor } from "../src/replay/viewpoint.js";

/** A trunk at the origin with legs towards `front`, a head at `head`, a robot at `robot`; nothing moves. */
function viewOf(front: readonly [number, number], robot: readonly [number, number], head = 1) {
  const geom = (role: string, x: number, y: number, z: number) => ({ type: "sphere", size: [0.1], pos: [x, y, z], role });
  const scene = readScene({
    bodies: ["world"],
    geoms: [geom("human", 0, 0, head), geom("human", ...front, 0.4), geom("robot", ...robot, 0.6)],
  });
  const clip = readClip({ frames: 1, bodies: [], poses: "" });
  assert.ok(scene && clip);
  return viewpointFor(scene, clip);
}

function lookAt(front: readonly [number, number], robot: readonly [number, number]) {
  const { position, target } = viewOf(front, robot);
  return position.sub(target);
}

test("the person is seen from the side they face, whichever side the robot is on", () => {
  for (const x of [-1, 1]) {
    assert.ok(lookAt([0, -0.5], [x, 0]).y < 0);
    assert.ok(lookAt([0, 0.5], [x, 0]).y > 0);
  }
});

test("the top of the head is in the picture, however tall the person is", () => {
  for (const height of [1, 1.5, 2.5]) {
    const { position, target } = viewOf([0, -0.5], [-1, 0], height);
    const camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
    camera.up.set(0, 0, 1);
    camera.position.copy(position);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    assert.ok(new Vector3(0, 0, height + 0.15).project(camera).y < 1);
  }
});

test("the view is from above and never at an undefined place", () => {
  assert.ok(lookAt([0, -0.5], [-1, 0]).z > 0);
  for (const v of lookAt([0, 0], [0, 0]).toArray()) assert.ok(Number.isFinite(v));
});
