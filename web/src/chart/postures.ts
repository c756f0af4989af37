/** A person with several arms: poses laid over one another, each with a verdict. */
import { h, s } from "../base/dom.js";
import { fixed } from "../base/format.js";
import type { Clip, Scene } from "../replay/clip.js";
import { appear, outlineOf, type Outline, type Picture, type Point } from "../replay/outline.js";
import { bodyPose, carry, poseAt } from "../replay/pose.js";

/** One pose: a frame of a clip, and D of the step it was taken from. */
export interface Posture {
  readonly clip: Clip;
  readonly frame: number;
  readonly score: number;
}

/** What part of the picture is seen [m]. */
export interface Window {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** A discriminator takes what it scores below this for canonical. */
export const BOUNDARY = 0;

/** The outlines of the limbs at one frame; without the first, which carries the others and hardly moves. */
function limbs(scene: Scene, { clip, frame }: Posture, picture: Picture): Outline[] {
  return scene.geoms.flatMap((geom) => {
    const slot = clip.bodies.indexOf(geom.body);
    return (slot > 0 && outlineOf(geom, poseAt(clip, slot, frame), picture)) || [];
  });
}

/** Those of the person that stay where they are. */
function trunk(scene: Scene, clip: Clip, picture: Picture): Outline[] {
  return scene.geoms
    .filter((geom) => geom.role === "human" && !clip.bodies.includes(geom.body))
    .flatMap((geom) => outlineOf(geom, bodyPose(scene, clip, geom.body, 0), picture) ?? []);
}

function draw(outline: Outline, thickness: number | null, kind: string): SVGElement {
  if (outline.kind === "ellipse") return s("circle", { class: kind, r: 1, transform: `matrix(${outline.matrix.join(" ")})` });
  const { from: [x1, y1], to: [x2, y2], radius } = outline;
  return s("path", { class: kind, d: `M${x1} ${y1}L${x2} ${y2}`, "stroke-width": thickness ?? 2 * radius });
}

/** The joints in order: where each moving body hangs from the one before, and the last one's end. */
function chain(scene: Scene, { clip, frame }: Posture, picture: Picture): Point[] {
  const joints = clip.bodies.map((_, slot) => appear(picture, poseAt(clip, slot, frame).position));
  const last = clip.bodies.length - 1;
  const hand = scene.geoms.find(({ body }) => body === clip.bodies[last]);
  return hand ? [...joints, appear(picture, carry(poseAt(clip, last, frame), hand.pos))] : joints;
}

/** The window that holds every pose and the head above them. */
export function windowOf(scene: Scene, postures: readonly Posture[], picture: Picture): Window {
  const [first] = postures;
  if (!first) return { x: 0, y: 0, width: 1, height: 1 };
  const arms = postures.flatMap((posture) => limbs(scene, posture, picture));
  const shoulder = Math.max(...postures.map((posture) => chain(scene, posture, picture)[0]?.[1] ?? 0));
  const above = trunk(scene, first.clip, picture).filter((outline) => middle(outline)[1] < shoulder + BELOW_SHOULDER);
  const boxes = [...arms, ...above].map(bounds);
  const x = Math.min(...boxes.map((box) => box.x)) - MARGIN;
  const y = Math.min(...boxes.map((box) => box.y)) - MARGIN;
  return {
    x, y,
    width: Math.max(...boxes.map((box) => box.x + box.width)) + MARGIN - x,
    height: Math.max(...boxes.map((box) => box.y + box.height)) + MARGIN - y,
  };
}

const MARGIN = 0.03;
/** Of the trunk what reaches no further below the shoulder is shown whole [m]. */
const BELOW_SHOULDER = 0.12;

function middle(outline: Outline): Point {
  if (outline.kind === "ellipse") return [outline.matrix[4], outline.matrix[5]];
  return [(outline.from[0] + outline.to[0]) / 2, (outline.from[1] + outline.to[1]) / 2];
}

function bounds(outline: Outline): Window {
  if (outline.kind === "ellipse") {
    const [a, b, c, d, x, y] = outline.matrix;
    const [w, t] = [Math.hypot(a, c), Math.hypot(b, d)];
    return { x: x - w, y: y - t, width: 2 * w, height: 2 * t };
  }
  const { from, to, radius } = outline;
  const [x, y] = [Math.min(from[0], to[0]) - radius, Math.min(from[1], to[1]) - radius];
  return { x, y, width: Math.abs(from[0] - to[0]) + 2 * radius, height: Math.abs(from[1] - to[1]) + 2 * radius };
}

function arm(scene: Scene, posture: Posture, picture: Picture): SVGGElement {
  const canonical = posture.score < BOUNDARY;
  const points = chain(scene, posture, picture);
  const [x, y] = points.at(-1) ?? [0, 0];
  const end = canonical
    ? s("circle", { class: "end", cx: x, cy: y, r: 0.017 })
    : s("path", { class: "end", d: `M${x - 0.02} ${y - 0.02}l0.04 0.04M${x - 0.02} ${y + 0.02}l0.04 -0.04` });
  return s("g", { class: `posture ${canonical ? "canonical" : "other"}` },
    s("title", {}, `D = ${fixed(posture.score)}`),
    ...limbs(scene, posture, picture).map((outline) => draw(outline, null, "flesh")),
    s("path", { class: "bone", d: `M${points.map((point) => point.join(" ")).join("L")}` }),
    end);
}

/** One picture with its title: the trunk, and an arm for each pose. */
export function posturePanel(title: string, postures: readonly Posture[], scene: Scene, picture: Picture, window: Window): HTMLElement {
  const canonical = postures.filter(({ score }) => score < BOUNDARY).length;
  const count = `${canonical} of ${postures.length} taken for canonical`;
  const { x, y, width, height } = window;
  const svg = s("svg", { class: "postures", viewBox: `${x} ${y} ${width} ${height}`, role: "img", "aria-label": `${title}: ${count}` });
  const [first] = postures;
  if (first) svg.append(s("g", { class: "trunk" }, ...trunk(scene, first.clip, picture).map((outline) => draw(outline, null, "flesh"))));
  // Who is suspicious lies on top.
  const order = [...postures].sort((p, q) => p.score - q.score);
  svg.append(...order.map((posture) => arm(scene, posture, picture)));
  return h("div", { class: "posture-panel" }, h("h4", {}, title), svg, h("p", { class: "note" }, count));
}
