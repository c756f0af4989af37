/** The participant's page: one screen for each stage that the server names. */
import "./styles/study.css";
import { h } from "../base/dom.js";
import { text } from "../base/read.js";
import { theme } from "../base/theme.js";
import { Server } from "./api.js";
import { Refused, type Disposable, type Mount, type State, type StudyContext, type Words } from "./context.js";
import { mountJudge } from "./judge/main.js";
import { mountPlay } from "./play/screen.js";
import { mountConsent } from "./screens/consent.js";
import { mountDemographics } from "./screens/demographics.js";
import { mountDone, mountStopped, mountWithdrawn } from "./screens/endings.js";
import { Shell } from "./screens/shell.js";
import { mountWatch } from "./screens/watch.js";
import { wordsOf } from "./words.js";

/** One screen may serve several kinds of stages in a row: they share its name. */
const SCREENS: Readonly<Record<string, readonly [name: string, mount: Mount]>> = {
  consent: ["consent", mountConsent],
  demographics: ["demographics", mountDemographics],
  watch: ["watch", mountWatch],
  practise: ["play", mountPlay],
  play: ["play", mountPlay],
  judge: ["judge", mountJudge],
  done: ["done", mountDone],
  stopped: ["stopped", mountStopped],
  withdrawn: ["withdrawn", mountWithdrawn],
};

class StudyPage {
  readonly #shell: Shell;
  #shown: { readonly key: string; readonly screen: Disposable } | null = null;

  constructor(private readonly server: Server, private readonly words: Words) {
    this.#shell = new Shell(words, {
      paused: () => this.#shown?.screen.pause?.(),
      resumed: () => this.#shown?.screen.resume?.(),
      stop: async () => this.show(await this.server.post("stop", {})),
      withdraw: async () => this.show(await this.server.post("withdraw", { confirm: "withdraw" })),
    });
    server.reached.watch((reached) => this.#shell.offline(!reached));
  }

  show(state: State): void {
    const kind = text(state.stage["kind"]);
    const [name, mount] = SCREENS[kind] ?? SCREENS["stopped"] as readonly [string, Mount];
    this.#shell.told(state);
    // Each watch or judge stage is a screen of its own; practise and play go on in the same one.
    const key = name === "play" ? name : `${name} ${text(state.stage["index"])}`;
    if (this.#shown?.key === key && this.#shown.screen.update) {
      this.#shown.screen.update(state);
      return;
    }
    this.#shown?.screen.dispose();
    const root = this.#shell.clear(name);
    const context: StudyContext = {
      api: this.server, words: this.words, state,
      announce: (message) => this.#shell.announce(message),
      proceed: (next) => this.show(next),
    };
    this.#shown = { key, screen: mount(root, context) };
    this.#shell.focus();
  }
}

/** Before any text of the language is there, or without it, English must do. */
function trouble(title: string, message: string): void {
  document.body.replaceChildren(h("main", { class: "card lonely" }, h("h1", {}, title), h("p", {}, message)));
}

async function start(): Promise<void> {
  const server = new Server(location);
  try {
    const [state, texts] = await Promise.all([server.state(), server.texts()]);
    document.documentElement.lang = state.language;
    document.title = state.title;
    new StudyPage(server, wordsOf(texts, state.language)).show(state);
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    trouble("This link does not work", "Please open the link exactly as it was sent to you. "
      + "If it still does not work, ask the people who sent it.");
  }
}

theme.watch(() => undefined); // Sets the page's theme, which follows the system's.
void start();
