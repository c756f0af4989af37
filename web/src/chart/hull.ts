/** The outermost boundary of a set of points, as drawn; the areas are computed in Python. */

export type XY = readonly [x: number, y: number];

/** Twice the signed area of the triangle: positive for a left turn. */
function turn([ax, ay]: XY, [bx, by]: XY, [cx, cy]: XY): number {
  return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

/**
 * Upper concave hull of the points and (0, y of the highest), left to right: nondecreasing
 * naturalness costs adversarialness, so the hull never rises.
 */
export function upperHull(points: readonly XY[]): XY[] {
  if (points.length === 0) return [];
  const top = Math.max(...points.map(([, y]) => y));
  const sorted = [[0, top] as XY, ...points].sort((a, b) => a[0] - b[0] || b[1] - a[1]);
  const hull: XY[] = [];
  for (const point of sorted) {
    if (hull.at(-1)?.[0] === point[0]) continue;
    while (hull.length > 1 && turn(hull.at(-2)!, hull.at(-1)!, point) >= 0) hull.pop();
    hull.push(point);
  }
  return hull;
}

export type Arrow = "ArrowLeft" | "ArrowRight" | "ArrowUp" | "ArrowDown" | "Home" | "End";

/** Which point a key leads to: left and right walk along x, up and down along y. */
export function neighbour(points: readonly XY[], from: number, key: Arrow): number {
  const axis = key === "ArrowUp" || key === "ArrowDown" ? 1 : 0;
  const value = (i: number): XY => points[i] ?? [0, 0];
  const order = points
    .map((_, i) => i)
    .sort((a, b) => value(a)[axis] - value(b)[axis] || value(a)[1 - axis]! - value(b)[1 - axis]! || a - b);
  if (key === "Home") return order[0] ?? from;
  if (key === "End") return order.at(-1) ?? from;
  const step = key === "ArrowRight" || key === "ArrowUp" ? 1 : -1;
  return order[order.indexOf(from) + step] ?? from;
}
