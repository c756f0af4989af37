/** What the server asks in a questionnaire, and how it wants the answers named. Pure. */
import { dict, list, number, text, type Dict } from "../../base/read.js";

export type Question = "correspondence" | "danger" | "naturalness";
export type Side = "left" | "right";
export const SIDES: readonly Side[] = ["left", "right"];
export const HIGHEST = 7;

/** One comparison; `left`, `right` and `reference` are keys of clips. */
export interface Trial {
  readonly id: string;
  /** Place in the participant's own order, from 0. */
  readonly position: number;
  readonly of: number;
  readonly left: string;
  readonly right: string;
  /** Canonical motion to compare with; null where nothing is compared with it. */
  readonly reference: string | null;
}

export interface Questionnaire {
  /** Place among the stages of the participant's role. */
  readonly index: number;
  readonly question: Question;
  readonly show: "snapshot" | "replay";
  /** Those not answered yet, in their order. */
  readonly trials: readonly Trial[];
}

/** One thing to answer in a trial: a number for a motion, or a choice between the two. */
export interface Item {
  /** As the server wants it, such as `goal-left`. */
  readonly name: string;
  /** What is asked, a key of the texts. */
  readonly scale: string;
  /** Whom it is about; null for a choice between the two. */
  readonly side: Side | null;
}

export type Answers = Readonly<Record<string, number | Side>>;

const SCALES: Readonly<Record<Question, readonly string[]>> = {
  correspondence: [],
  danger: ["goal", "danger"],
  naturalness: ["naturalness"],
};

function readTrial(value: unknown): Trial {
  const raw = dict(value);
  return {
    id: text(raw["id"]),
    position: number(raw["position"]) ?? 0,
    of: number(raw["of"]) ?? 0,
    left: text(raw["left"]),
    right: text(raw["right"]),
    reference: typeof raw["reference"] === "string" ? raw["reference"] : null,
  };
}

/** The questionnaire of a stage; null for any other stage, or a question that this page knows not. */
export function readQuestionnaire(stage: Dict): Questionnaire | null {
  const question = text(stage["question"]);
  if (stage["kind"] !== "judge" || !(Object.hasOwn(SCALES, question))) return null;
  return {
    index: number(stage["index"]) ?? 0,
    question: question as Question,
    show: stage["show"] === "snapshot" ? "snapshot" : "replay",
    trials: list(stage["trials"]).map(readTrial),
  };
}

/** What a trial asks, in the order in which it is answered: scale by scale, left before right. */
export function itemsOf(question: Question): readonly Item[] {
  if (question === "correspondence") return [{ name: question, scale: question, side: null }];
  return SCALES[question].flatMap((scale) => SIDES.map((side) => ({ name: `${scale}-${side}`, scale, side })));
}

/** Names of what still lacks an answer. */
export function unanswered(question: Question, answers: Answers): readonly string[] {
  return itemsOf(question).map(({ name }) => name).filter((name) => !Object.hasOwn(answers, name));
}

/** What a key stands for: a digit on a scale, A or B in a choice; null for any other key. */
export function answerOfKey(question: Question, key: string): number | Side | null {
  if (question !== "correspondence") return /^[0-7]$/.test(key) ? Number(key) : null;
  return ({ a: "left", b: "right" } as const)[key.toLowerCase() as "a" | "b"] ?? null;
}
