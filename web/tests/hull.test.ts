import assert from "node:assert/strict";
import { test } from "node:test";
import { neighbour, upperHull, type XY } from "../src/chart/hull.js";

test("the hull leaves out a point below the line between its neighbours", () => {
  assert.deepEqual(upperHull([[0.2, 0.9], [0.5, 0.4], [0.9, 0.3]]), [[0, 0.9], [0.2, 0.9], [0.9, 0.3]]);
});

test("the hull keeps a point above the line between its neighbours", () => {
  const hull = upperHull([[0.2, 0.9], [0.5, 0.8], [0.9, 0.3]]);
  assert.deepEqual(hull, [[0, 0.9], [0.2, 0.9], [0.5, 0.8], [0.9, 0.3]]);
});

test("of two points with one naturalness the hull takes the worse", () => {
  assert.deepEqual(upperHull([[1, 0.1], [1, 0.3], [0.2, 0.8]]), [[0, 0.8], [0.2, 0.8], [1, 0.3]]);
});

test("no points, no hull", () => {
  assert.deepEqual(upperHull([]), []);
});

const POINTS: XY[] = [[0.9, 0.1], [0.1, 0.8], [0.5, 0.9]];

test("right goes to the next more natural point, left back", () => {
  assert.equal(neighbour(POINTS, 1, "ArrowRight"), 2);
  assert.equal(neighbour(POINTS, 2, "ArrowLeft"), 1);
});

test("up goes to the next more adversarial point", () => {
  assert.equal(neighbour(POINTS, 0, "ArrowUp"), 1);
  assert.equal(neighbour(POINTS, 1, "ArrowUp"), 2);
});

test("keys stop at the ends", () => {
  assert.equal(neighbour(POINTS, 0, "ArrowRight"), 0);
  assert.equal(neighbour(POINTS, 2, "ArrowUp"), 2);
  assert.equal(neighbour(POINTS, 2, "Home"), 1);
  assert.equal(neighbour(POINTS, 2, "End"), 0);
});

test("points in one place are all reached", () => {
  const same: XY[] = [[0.5, 0.5], [0.5, 0.5], [0.5, 0.5]];
  assert.equal(neighbour(same, 0, "ArrowRight"), 1);
  assert.equal(neighbour(same, 1, "ArrowRight"), 2);
});
