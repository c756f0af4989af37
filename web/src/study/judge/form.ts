/** The questions of a trial: scales from 0 to 7, or a choice of two; all by keyboard as well. */
import { h, on } from "../../base/dom.js";
import type { Words } from "../context.js";
import {
  answerOfKey, HIGHEST, itemsOf, SIDES, unanswered, type Answers, type Item, type Question, type Side,
} from "./questionnaire.js";

interface Option {
  readonly value: number | Side;
  readonly input: HTMLInputElement;
  readonly element: HTMLElement;
}

/** One item as a group of radio buttons. */
class Group {
  readonly element: HTMLElement;
  readonly #options: readonly Option[];
  readonly #missing: HTMLElement;

  constructor(readonly item: Item, words: Words, show: string) {
    const { name, scale, side } = item;
    this.#missing = h("p", { class: "missing", id: `missing-${name}`, hidden: true }, words("judge.missing"));
    const values = side ? Array.from({ length: HIGHEST + 1 }, (_, value) => value) : SIDES;
    this.#options = values.map((value) => option(name, value, words, show));
    const about = side ? `${words(`judge.ask.${scale}`)} ${words(`judge.motion.${side}`)}` : words(`judge.ask.${scale}.${show}`);
    this.element = h("fieldset", { "aria-describedby": this.#missing.id },
      h("legend", { class: "visually-hidden" }, about),
      h("div", { class: side ? "rating" : "choice" },
        side && h("span", { class: "whom", "aria-hidden": "true" }, words(`judge.motion.${side}`)),
        h("div", { class: "marks" }, ...this.#options.map(({ element }) => element)),
        side && h("div", { class: "ends", "aria-hidden": "true" },
          h("span", {}, words(`judge.lowest.${scale}`)), h("span", {}, words(`judge.highest.${scale}`))),
        this.#missing));
    on(this.element, { change: () => this.complain(false) });
  }

  get value(): number | Side | null {
    return this.#options.find(({ input }) => input.checked)?.value ?? null;
  }

  choose(value: number | Side): void {
    const found = this.#options.find((option) => option.value === value);
    if (!found) return;
    found.input.checked = true;
    this.complain(false);
  }

  complain(missing: boolean): void {
    this.#missing.hidden = !missing;
    this.element.classList.toggle("open", missing);
  }

  focus(): void {
    (this.#options.find(({ input }) => input.checked) ?? this.#options[0])?.input.focus();
  }
}

function option(name: string, value: number | Side, words: Words, show: string): Option {
  const input = h("input", { type: "radio", name, value });
  const shown = typeof value === "number" ? String(value) : words(`judge.choose.${show}.${value}`);
  return { value, input, element: h("label", { class: "mark" }, input, h("span", {}, shown)) };
}

export class QuestionForm {
  readonly element: HTMLFormElement;
  readonly #groups: readonly Group[];
  readonly #next: HTMLButtonElement;

  constructor(
    private readonly question: Question, show: string, words: Words,
    private readonly submitted: (answers: Answers) => void,
  ) {
    this.#groups = itemsOf(question).map((item) => new Group(item, words, show));
    this.#next = h("button", { type: "submit", class: "primary" }, words("judge.next"));
    const blocks = [...new Set(itemsOf(question).map(({ scale }) => scale))].map((scale) =>
      h("div", { class: question === "danger" ? "block" : "block beside-reference" },
        h("p", { class: "ask", "aria-hidden": "true" }, // The legends say it.
          words(question === "correspondence" ? `judge.ask.${scale}.${show}` : `judge.ask.${scale}`)),
        h("div", { class: question === "correspondence" ? "" : "answers" },
          ...this.#groups.filter(({ item }) => item.scale === scale).map(({ element }) => element))));
    const keys = words(question === "correspondence" ? "judge.keys.choice" : "judge.keys.scale");
    this.element = h("form", { class: "questions", novalidate: true }, ...blocks,
      h("div", { class: "actions" }, this.#next, h("span", { class: "keys" }, keys)));
    on(this.element, { submit: (event) => {
      event.preventDefault();
      this.submit();
    } });
  }

  get #answers(): Answers {
    return Object.fromEntries(this.#groups.flatMap(({ item, value }) => (value === null ? [] : [[item.name, value]])));
  }

  /** Sends the answers, or says which are missing. */
  submit(): void {
    if (this.#next.disabled) return;
    const open = new Set(unanswered(this.question, this.#answers));
    const lacking = this.#groups.filter(({ item }) => open.has(item.name));
    for (const group of this.#groups) group.complain(lacking.includes(group));
    if (lacking.length === 0) this.submitted(this.#answers);
    else lacking[0]?.focus();
  }

  /** Takes a key that was pressed anywhere in the trial; whether it was one of ours. */
  key(pressed: string): boolean {
    const value = answerOfKey(this.question, pressed);
    if (value === null || this.#next.disabled) return false;
    const focused = this.#groups.find(({ element }) => element.contains(document.activeElement));
    const open = (): Group | undefined => this.#groups.find((group) => group.value === null);
    const group = focused ?? open() ?? this.#groups[0];
    group?.choose(value);
    const following = open();
    if (following) following.focus();
    else this.#next.focus();
    return true;
  }
}
