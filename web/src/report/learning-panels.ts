/** Which learning curves can be drawn, from what was recorded. */
import { fixed, percent } from "../base/format.js";
import { type Dict, numbers } from "../base/read.js";
import type { Panel, Series } from "../chart/lines.js";

function series(curves: Dict, length: number, wanted: readonly (readonly [field: string, name: string, kind: string])[]): Series[] {
  return wanted.flatMap(([field, name, kind]) => {
    const values = numbers(curves[field]);
    return values.length === length && values.some(Number.isFinite) ? [{ name, kind, values }] : [];
  });
}

/** The panels that the recorded curves allow. */
export function panelsOf(curves: Dict): Panel[] {
  const x = numbers(curves["iteration"]);
  if (x.length < 2) return [];
  const of = (...wanted: (readonly [string, string, string])[]): Series[] => series(curves, x.length, wanted);
  const panels: Panel[] = [
    { title: "Return of the robot", x, xName: "iteration", format: (v) => fixed(v, 0),
      series: of(["return", "", "plain"]) },
    { title: "Discriminator score", x, xName: "iteration", domain: [-1.2, 1.2], format: (v) => fixed(v, 1),
      series: of(["score_canonical", "canonical", "canonical"], ["score_adversary", "adversary", "unwanted"]) },
    { title: "Discriminator accuracy", x, xName: "iteration", domain: [0, 1], format: percent,
      series: of(["accuracy_canonical", "canonical", "canonical"], ["accuracy_adversary", "adversary", "unwanted"]) },
    { title: "Entropy of the policy", x, xName: "iteration", format: (v) => fixed(v, 1),
      series: of(["entropy", "", "plain"]) },
  ];
  return panels.filter((panel) => panel.series.length > 0);
}
