/** What the chosen human's discriminator tells apart (paper, 'Visualizations of the Discriminator'). */
import { Vector3 } from "three";
import { caption, h, s } from "../base/dom.js";
import { count, percent } from "../base/format.js";
import { text } from "../base/read.js";
import { lambdaRange, lambdaShare, lambdaStyle } from "../chart/palette.js";
import { noisePanel, type NoiseLine } from "../chart/noise.js";
import { posturePanel, windowOf, type Posture } from "../chart/postures.js";
import { toldPanel, type ToldPoint } from "../chart/told.js";
import type { Clip } from "../replay/clip.js";
import { pictureFrom } from "../replay/outline.js";
import { viewpointFor } from "../replay/viewpoint.js";
import type { Discriminators, Judged } from "./discriminators.js";
import type { Payload, Point } from "./payload.js";
import { isPassive, title } from "./words.js";

type Style = (point: Point) => string;

/** The figures for a human, or a sentence that says why there are none. */
export function discriminatorFigures(payload: Payload, point: Point | null, choose: (id: string) => void): Node[] {
  const seen = point && payload.discriminators.get(String(point.seed));
  const judged = point && seen?.judged?.get(point.id);
  if (!point || !seen || !judged) return [h("p", { class: "empty" }, missing(payload, point, seen ?? null))];
  const range = lambdaRange(payload.points.map(({ lambda }) => lambda));
  const style: Style = ({ lambda }) => lambdaStyle(lambdaShare(lambda, range));
  const mates = payload.points.filter(({ seed }) => seed === point.seed);
  return [
    toldFigure(seen, judged, point, mates, style, choose),
    ...postureFigure(payload, seen, judged, point),
  ];
}

function missing(payload: Payload, point: Point | null, seen: Discriminators | null): string {
  if (point && isPassive(point)) return "The passive human was never trained, so it has no discriminator.";
  if (seen && seen.judged === null) {
    return `The search measure of this run (${text(payload.frontier["search_measure"], "unknown")}) trains no discriminator.`;
  }
  return "What the discriminator tells apart is unknown: it was not examined when this human was measured.";
}

function toldFigure(
  seen: Discriminators, judged: Judged, point: Point, mates: readonly Point[], style: Style, choose: (id: string) => void,
): HTMLElement {
  const others = mates.flatMap((mate): NoiseLine[] => {
    const values = mate.id === point.id ? undefined : seen.judged?.get(mate.id)?.discriminator.canonical;
    return values ? [{ name: null, kind: "other", style: style(mate), values }] : [];
  });
  const own: NoiseLine[] = [
    { name: "discriminator", kind: "discriminator", style: style(point), values: judged.discriminator.canonical },
    ...(judged.referee ? [{ name: "referee", kind: "referee", style: "", values: judged.referee.canonical } as const] : []),
  ];
  const humans = mates.flatMap((mate): ToldPoint[] => {
    if (mate.lambda === null) return [];
    const discriminator = judged.discriminator.adversaries.get(mate.id) ?? NaN;
    const referee = judged.referee?.adversaries.get(mate.id) ?? NaN;
    const said = [`discriminator ${share(discriminator)}`, `referee ${share(referee)}`];
    return [{
      id: mate.id, lambda: mate.lambda, discriminator, referee, style: style(mate),
      label: `${title(mate)}, taken for not canonical: ${said.join(", ")}`,
      lines: [title(mate), "taken for not canonical by", ...said],
    }];
  });
  return h("figure", { class: "told-figure" },
    key(judged.referee !== null, others.length > 0),
    h("div", { class: "told-pair" },
      noisePanel("Held-out canonical motion under noise", seen.levels, [...others, ...own]),
      toldPanel("Every human of this seed", humans, point.id, choose)),
    caption(
      `How often the discriminator of ${title(point)} is right. Under noise: the share of held-out canonical steps (${count(seen.canonicalEpisodes)} episodes) that it takes for canonical (D\u00a0<\u00a00: low is canonical), with noise on every feature that moves, in units of its canonical deviation σ. Of every human: the share of their steps (${count(seen.adversaryEpisodes)} episodes each) that it takes for not canonical (D\u00a0≥\u00a00). Dashed, the same of this human's referee.`,
      "Both only learned to tell this one human (the discriminator also its neighbours, where λ share a network) from canonical motion: noise, and humans that they never met, may pass; nor is a low share a mistake where a human moves naturally. The discriminator is the search's own, a different ruler for every human; naturalness on the frontier is the referee's verdict on its own human, and on no other: the share of steps that it takes for canonical, and κ times the share of canonical steps that it does not.",
      "Choose a mark to see its discriminator.",
    ));
}

function share(value: number): string {
  return percent(Number.isFinite(value) ? value : null);
}

function key(referee: boolean, others: boolean): HTMLElement {
  const sample = (kind: string): SVGSVGElement =>
    s("svg", { class: "told-sample", viewBox: "-10 -8 20 16", width: 20, height: 16, "aria-hidden": "true" },
      s("path", { class: `series told-${kind}`, d: "M-9 0H9" }),
      kind === "referee" && s("path", { class: "referee-mark", d: "M0 -5l5 5l-5 5l-5 -5Z" }),
      kind === "discriminator" && s("circle", { r: 4.5 }));
  return h("ul", { class: "legend" },
    h("li", {}, sample("discriminator"), "its discriminator, coloured by λ"),
    others && h("li", {}, sample("other"), "those of the seed's other λ"),
    referee && h("li", {}, sample("referee"), "its referee, which rules the x axis"));
}

/** Frames of a clip from `first` on, those of known score. */
function postures(clip: Clip, scores: readonly number[], first = 0): Posture[] {
  const frames = scores.map((score, i) => ({ clip, frame: first + i, score }));
  return frames.filter(({ frame, score }) => frame < clip.frames && Number.isFinite(score));
}

/** No figure where the task has no picture, or its features tell no pose. */
function postureFigure(payload: Payload, seen: Discriminators, judged: Judged, point: Point): HTMLElement[] {
  const { scene } = payload;
  const { poses } = seen;
  if (!scene || !poses || poses.levels.length === 0) return [];
  const { position, target } = viewpointFor(scene, poses.noisy);
  const { x, y, z } = new Vector3().subVectors(position, target);
  const picture = pictureFrom([x, y, z]);
  const each = Math.floor(poses.noisy.frames / poses.levels.length);
  const clip = poses.own.get(point.id);
  const shown = [
    ...poses.levels.map((level, i) =>
      [noiseTitle(level), postures(poses.noisy, (judged.scores.noisy[i] ?? []).slice(0, each), i * each)] as const),
    ["this human", clip ? postures(clip, judged.scores.own) : []] as const,
  ].filter(([, group]) => group.length > 0);
  if (shown.length === 0) return [];
  const window = windowOf(scene, shown.flatMap(([, group]) => group), picture);
  const panels = shown.map(([name, group]) => posturePanel(name, group, scene, picture, window));
  return [h("figure", { class: "posture-figure" },
    h("ul", { class: "legend" },
      h("li", {}, verdictSample("canonical"), "taken for canonical, D\u00a0<\u00a00"),
      h("li", {}, verdictSample("other"), "taken for not canonical, D\u00a0≥\u00a00")),
    h("div", { class: "posture-panels" }, ...panels),
    caption(
      `The right arm at ${count(each)} canonical steps under rising noise, and at steps of ${title(point)}, with the verdict of its discriminator.`,
      "The discriminator sees the whole step, speeds and the itch included, of which a pose shows a part; noise knows no joint limits. A few poses are an illustration: the shares are above.",
    ))];
}

function noiseTitle(level: number): string {
  return level === 0 ? "canonical" : `noise ${Number(level.toPrecision(2))} σ`;
}

function verdictSample(kind: "canonical" | "other"): SVGSVGElement {
  const end = kind === "canonical"
    ? s("circle", { class: "end", cx: 9, cy: 0, r: 3.4 })
    : s("path", { class: "end", d: "M5 -4l8 8M5 4l8 -8" });
  return s("svg", { class: "verdict-sample", viewBox: "-14 -8 30 16", width: 30, height: 16, "aria-hidden": "true" },
    s("g", { class: `posture ${kind}` }, s("path", { class: "bone", d: "M-13 0H7" }), end));
}
