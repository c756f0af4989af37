/** Questionnaires: jsPsych asks about one pair after the other, until the server has all answers. */
import { initJsPsych } from "jspsych";
import "./judge.css";
import { h } from "../../base/dom.js";
import { text, type Dict } from "../../base/read.js";
import { Refused, type Mount, type State, type StudyContext } from "../context.js";
import { sending } from "../screens/sending.js";
import { prose } from "../words.js";
import { IntroPlugin, PairPlugin, type Room } from "./plugin.js";
import { readQuestionnaire, type Questionnaire, type Trial } from "./questionnaire.js";
import { Theatre, type Role } from "./theatre.js";

/** The server's state decides what is left: answers that it took elsewhere are not asked again. */
class Sitting {
  #state: State;

  constructor(private readonly context: StudyContext, readonly asks: Questionnaire) {
    this.#state = context.state;
  }

  get state(): State {
    return this.#state;
  }

  /** Trials without an answer; none once the server says that the questionnaire is over. */
  get left(): readonly Trial[] {
    const now = readQuestionnaire(this.#state.stage);
    return now?.index === this.asks.index ? now.trials : [];
  }

  async answer(trial: Trial, responses: Readonly<Record<string, unknown>>, rt: number): Promise<void> {
    this.#state = await this.#sent(trial, { stage: this.asks.index, trial: trial.id, responses, rt });
    for (const key of keysOf(this.left[1])) void this.context.api.clip(key).catch(() => undefined);
  }

  /** The state after an answer; also where the trial was answered in another window, whose answer stays. */
  async #sent(trial: Trial, answer: Dict): Promise<State> {
    const { api } = this.context;
    try {
      return await api.post("answer", answer);
    } catch (error) {
      const now = error instanceof Refused && error.code === "not-now" ? await api.state() : null;
      const asked = readQuestionnaire(now?.stage ?? {});
      const isOpen = asked?.index === this.asks.index && asked.trials.some(({ id }) => id === trial.id);
      if (now === null || isOpen) throw error;
      return now;
    }
  }
}

/** The clips of a trial. */
function keysOf(trial: Trial | undefined): readonly string[] {
  return trial ? [trial.left, trial.right, trial.reference].filter((key) => key !== null) : [];
}

function rolesOf(trials: readonly Trial[]): readonly Role[] {
  return trials.some(({ reference }) => reference !== null) ? ["reference", "left", "right"] : ["left", "right"];
}

function introduction(sitting: Sitting, { words, state }: StudyContext): HTMLElement[] {
  const { question, show, trials } = sitting.asks;
  const own = text(state.stage["instructions"]);
  const of = trials[0]?.of ?? trials.length;
  const told = own ? [prose(own)] : words.list(`judge.intro.${question}.${show}`).map((line) => h("p", {}, line));
  const count = trials.length < of ? words("judge.left", { count: trials.length, of }) : words("judge.many", { count: of });
  return [h("h1", {}, words(`judge.title.${question}`)), ...told, h("p", { class: "soft" }, count)];
}

async function run(root: HTMLElement, context: StudyContext, sitting: Sitting, theatre: Theatre): Promise<void> {
  const { words, api } = context;
  const { question, show } = sitting.asks;
  const room: Room = {
    words, question, show, theatre,
    clip: (key) => api.clip(key),
    announce: (message) => context.announce(message),
    answer: async (trial, answers, seconds, part) => {
      let taken = false;
      await sending(part, words, (message) => context.announce(message), async () => {
        await sitting.answer(trial, answers, seconds);
        taken = true;
      });
      return taken;
    },
  };
  const jsPsych = initJsPsych({ display_element: root, use_webaudio: false });
  const intro = { type: IntroPlugin, says: () => introduction(sitting, context), begin: words("judge.begin") };
  const pairs = {
    timeline: [{ type: PairPlugin, pair: () => sitting.left[0], room }],
    loop_function: () => sitting.left.length > 0,
  };
  await jsPsych.run(sitting.left.length > 0 ? [intro, pairs] : [intro]);
}

export const mountJudge: Mount = (root, context) => {
  const { words, api } = context;
  const asks = readQuestionnaire(context.state.stage);
  const place = h("div", { class: "judge-place" }, h("p", { class: "count", role: "status" }, words("judge.loading")));
  root.append(place);
  let theatre: Theatre | null = null;
  let gone = false;

  const start = async (sitting: Sitting): Promise<void> => {
    const scene = await api.scene();
    if (gone) return;
    theatre = scene && new Theatre(rolesOf(sitting.asks.trials), scene, words);
    if (!theatre?.draws) {
      place.replaceChildren(h("p", { class: "problem" }, words(theatre ? "shell.no-webgl" : "judge.damaged")));
      return;
    }
    place.replaceChildren();
    await run(place, context, sitting, theatre);
    if (!gone) context.proceed(sitting.state);
  };
  if (asks) void start(new Sitting(context, asks));
  else place.replaceChildren(h("p", { class: "problem" }, words("judge.damaged")));
  return {
    pause: () => theatre?.halt(),
    dispose: () => {
      gone = true;
      theatre?.dispose();
    },
  };
};
