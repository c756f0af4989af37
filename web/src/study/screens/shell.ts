/** What stays around every screen: title, progress, how to stop, and what is said aloud. */
import { button, h, on } from "../../base/dom.js";
import type { State, Words } from "../context.js";

export interface ShellHandlers {
  /** Whether to stop is being thought about. */
  paused(): void;
  resumed(): void;
  stop(): Promise<void>;
  withdraw(): Promise<void>;
}

export class Shell {
  readonly #title = h("p", { class: "study-title" });
  readonly #step = h("p", { class: "study-step" });
  readonly #dots = h("ol", { class: "study-dots", "aria-hidden": "true" });
  readonly #main = h("main", { id: "screen", tabindex: -1 });
  readonly #said = h("p", { class: "visually-hidden", role: "status", "aria-live": "polite" });
  readonly #offline: HTMLElement;
  readonly #stop: HTMLButtonElement;
  readonly #dialog: HTMLDialogElement;

  constructor(private readonly words: Words, private readonly handlers: ShellHandlers) {
    this.#stop = button(words("shell.stop"), () => this.#ask(), { class: "stop" });
    this.#offline = h("p", { class: "offline", role: "status", hidden: true }, words("shell.offline"));
    this.#dialog = this.#leaving();
    document.body.replaceChildren(
      h("header", { class: "study-bar" },
        h("div", { class: "study-where" }, this.#title, this.#step), this.#dots, this.#stop),
      this.#offline, this.#main, this.#said, this.#dialog);
  }

  /** An empty place for a screen of this name. */
  clear(name: string): HTMLElement {
    document.body.dataset["screen"] = name;
    this.#main.replaceChildren();
    scrollTo(0, 0);
    return this.#main;
  }

  /** The keyboard and the screen reader begin at the new screen. */
  focus(): void {
    const start = this.#main.querySelector<HTMLElement>("[data-start]:enabled, h1") ?? this.#main;
    if (!start.hasAttribute("tabindex") && start.tagName === "H1") start.tabIndex = -1;
    start.focus({ preventScroll: true });
  }

  announce(message: string): void {
    this.#said.textContent = "";
    setTimeout(() => (this.#said.textContent = message)); // The same words again are said again.
  }

  offline(gone: boolean): void {
    this.#offline.hidden = !gone;
  }

  /** Shows where in the study the participant is. */
  told({ title, before, stages, stage, canStop }: State): void {
    const kind = String(stage["kind"]);
    const all = [...before, ...stages.map((entry) => entry.kind)];
    const index = typeof stage["index"] === "number" ? stage["index"] + before.length : Math.max(0, before.indexOf(kind));
    const ended = kind === "done" || kind === "stopped" || kind === "withdrawn";
    this.#title.textContent = title;
    this.#step.textContent = ended ? "" : this.words("shell.step", {
      number: index + 1, of: all.length, name: this.words(`shell.kinds.${kind}`),
    });
    this.#dots.replaceChildren(...(ended ? [] : all.map((_, i) =>
      h("li", { class: i < index ? "past" : i === index ? "now" : "" }))));
    this.#stop.hidden = !canStop;
  }

  #ask(): void {
    this.handlers.paused();
    this.#dialog.showModal();
  }

  #leaving(): HTMLDialogElement {
    const { words, handlers } = this;
    const dialog = h("dialog", { class: "leaving", "aria-labelledby": "leaving-title" });
    const first = h("div", { class: "leaving-part" });
    const sure = h("div", { class: "leaving-part", hidden: true });
    const back = (): void => dialog.close();
    /** Shows one of the two, and takes the keyboard to it. */
    const part = (shown: HTMLElement): void => {
      [first.hidden, sure.hidden] = [shown !== first, shown !== sure];
      dialog.setAttribute("aria-labelledby", shown.querySelector("h2")?.id ?? "");
      shown.querySelector("button")?.focus();
    };
    const leave = (act: () => Promise<void>): void => {
      dialog.dataset["left"] = "yes";
      dialog.close();
      void act();
    };
    first.append(
      h("h2", { id: "leaving-title" }, words("leave.title")), h("p", {}, words("leave.says")),
      h("div", { class: "actions column" },
        button(words("leave.back"), back, { class: "primary" }),
        button(words("leave.stop"), () => leave(() => handlers.stop())),
        button(words("leave.withdraw"), () => part(sure), { class: "danger" })));
    sure.append(
      h("h2", { id: "leaving-sure" }, words("leave.sure")), h("p", {}, words("leave.sure-says")),
      h("div", { class: "actions column" },
        button(words("leave.not-sure"), () => part(first), { class: "primary" }),
        button(words("leave.delete"), () => leave(() => handlers.withdraw()), { class: "danger" })));
    dialog.append(first, sure);
    return on(dialog, {
      close: () => {
        part(first);
        if (dialog.dataset["left"] !== "yes") handlers.resumed();
        delete dialog.dataset["left"];
      },
    });
  }
}
