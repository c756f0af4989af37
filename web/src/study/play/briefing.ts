/** What participants are told before an episode: one sentence at a time, less each time. */
import { number, text } from "../../base/read.js";
import type { State, Words } from "../context.js";
import type { Way } from "./devices.js";

export interface Step {
  /** `ways`: the answer is how to move the hand. */
  readonly kind: "sentence" | "ways";
  readonly line: string;
  readonly hint: string;
}

/** Such as "Practice 1 of 2". */
export function headingOf({ stage }: State, words: Words): string {
  const of = number(stage["of"]) ?? 1;
  const next = Math.min((number(stage["done"]) ?? 0) + 1, of);
  return words(`play.heading.${text(stage["kind"])}`, { number: next, of });
}

/** The sentences before the next episode of a state; the last one leads to its start. */
export function briefing({ stage }: State, words: Words, way: Way | null): Step[] {
  const isFirst = (number(stage["done"]) ?? 0) === 0;
  const manner = `play.manner.${text(stage["manner"], "own-way")}`;
  const sentence = (line: string, hint = ""): Step => ({ kind: "sentence", line, hint });
  const task = text(stage["instructions"]) || words(isFirst ? `${manner}.first` : `${manner}.again`);
  const choice: Step = { kind: "ways", line: words("play.choose"), hint: words("play.choose-hint") };
  const how = way === null ? [choice] : [];
  if (!isFirst) return [...how, sentence(task, words("play.stored"))];
  if (stage["kind"] !== "practise") return [...how, sentence(task, words("play.starts"))];
  return [
    sentence(words("play.role"), words("play.role-hint")), choice,
    sentence(words(`play.ways.${way ?? "mouse"}.how`), words(`play.ways.${way ?? "mouse"}.more`)),
    sentence(task, words("play.starts")),
  ];
}
