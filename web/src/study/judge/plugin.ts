/** jsPsych's trials: the words before a questionnaire, and a pair of motions with its questions. */
import { ParameterType, type JsPsychPlugin, type TrialType } from "jspsych";
import { button, h, on } from "../../base/dom.js";
import type { Clip } from "../../replay/clip.js";
import type { Words } from "../context.js";
import { QuestionForm } from "./form.js";
import type { Answers, Question, Trial } from "./questionnaire.js";
import type { Role, Theatre } from "./theatre.js";

/** What all trials of a questionnaire share. */
export interface Room {
  readonly words: Words;
  readonly question: Question;
  readonly show: "snapshot" | "replay";
  readonly theatre: Theatre;
  clip(key: string): Promise<Clip | null>;
  announce(message: string): void;
  /** Resolves once the server has it; what it refuses is said in `part`, and false returned. */
  answer(trial: Trial, answers: Answers, seconds: number, part: HTMLElement): Promise<boolean>;
}

const VERSION = "1.0.0";

const introInfo = {
  name: "rigid-judge-intro",
  version: VERSION,
  parameters: {
    /** Builds what is said. */
    says: { type: ParameterType.FUNCTION, default: undefined },
    begin: { type: ParameterType.STRING, default: undefined },
  },
  data: {},
} as const;

/** Text and one button. */
export class IntroPlugin implements JsPsychPlugin<typeof introInfo> {
  static readonly info = introInfo;

  async trial(display: HTMLElement, trial: TrialType<typeof introInfo>, loaded?: () => void): Promise<object> {
    return new Promise((done) => {
      const begin = button(trial.begin, () => done({}), { class: "primary" });
      display.append(h("div", { class: "card judge-intro" }, ...(trial.says as () => HTMLElement[])(), h("div", { class: "actions" }, begin)));
      loaded?.();
      focusOn(display.querySelector("h1"));
    });
  }
}

const pairInfo = {
  name: "rigid-judge-pair",
  version: VERSION,
  parameters: {
    /** `Trial`: ids and keys of clips. */
    pair: { type: ParameterType.OBJECT, default: undefined },
    /** `Room`. */
    room: { type: ParameterType.COMPLEX, default: undefined },
  },
  data: {
    /** Id of the trial. */
    pair: { type: ParameterType.STRING },
    /** `Answers`, as they were sent. */
    responses: { type: ParameterType.OBJECT },
    /** From the moment that the motions are there [ms]. */
    rt: { type: ParameterType.FLOAT },
  },
} as const;

/** Two motions, beside a reference where there is one, and what is asked about them. */
export class PairPlugin implements JsPsychPlugin<typeof pairInfo> {
  static readonly info = pairInfo;

  async trial(display: HTMLElement, trial: TrialType<typeof pairInfo>, loaded?: () => void): Promise<object> {
    const pair = trial.pair as Trial;
    const room = trial.room as Room;
    const { words, theatre } = room;
    const count = words("judge.count", { number: pair.position + 1, of: pair.of });
    const heading = h("h1", { tabindex: -1, "data-start": true }, count);
    const done = h("progress", { max: pair.of, value: pair.position, "aria-hidden": "true" });
    const section = h("section", { class: "judge" }, h("div", { class: "judge-head" }, heading, done));
    display.append(section);
    const clips = await clipsOf(pair, room);
    if (!clips) {
      section.append(h("p", { class: "problem" }, words("judge.damaged")));
      return new Promise(() => undefined); // Nobody can judge what cannot be seen.
    }
    return new Promise((finish) => {
      const form = new QuestionForm(room.question, room.show, words, (answers) => void send(answers));
      const send = async (responses: Answers): Promise<void> => {
        const rt = performance.now() - start;
        if (!await room.answer(pair, responses, rt / 1000, form.element)) return;
        theatre.halt();
        finish({ pair: pair.id, responses, rt });
      };
      section.append(theatre.element, form.element);
      on(section, { keydown: (event) => listen(event, form, theatre) });
      theatre.show(clips);
      const start = performance.now();
      loaded?.();
      focusOn(heading);
      room.announce(count);
    });
  }
}

async function clipsOf(pair: Trial, room: Room): Promise<Readonly<Record<Role, Clip | null>> | null> {
  const [left, right, reference] = await Promise.all([
    room.clip(pair.left), room.clip(pair.right), pair.reference === null ? null : room.clip(pair.reference),
  ]);
  const whole = left && right && (reference !== null || pair.reference === null);
  return whole ? { left, right, reference } : null;
}

/** jsPsych takes the focus to its container: screen readers begin at the heading instead. */
function focusOn(heading: HTMLElement | null): void {
  if (heading === null) return;
  heading.tabIndex = -1;
  heading.focus({ preventScroll: true });
  heading.scrollIntoView({ block: "nearest" });
}

/** Keys anywhere in a trial: answers, space to play, enter to go on. */
function listen(event: KeyboardEvent, form: QuestionForm, theatre: Theatre): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const target = event.target as HTMLElement;
  const pressing = target instanceof HTMLButtonElement; // Space and enter press it.
  let ours = form.key(event.key);
  if (!ours && event.key === " " && !pressing && !(target instanceof HTMLInputElement)) {
    theatre.toggle();
    ours = true;
  }
  if (!ours && event.key === "Enter" && !pressing) {
    form.submit();
    ours = true;
  }
  if (ours) event.preventDefault();
}
