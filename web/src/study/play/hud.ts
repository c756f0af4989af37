/** What is said over the 3D view: one sentence at a time, the time left, what can be done next. */
import { button, h } from "../../base/dom.js";

/** One thing to do now. */
export interface Action {
  readonly id: string;
  readonly label: string;
  readonly primary?: boolean;
  run(): void;
}

/** Touched again within so long [ms], nothing is read aloud: a robot that scrapes along would never be silent. Ours. */
const QUIET = 4000;
/** What is to be seen around the middle [px]. Ours. */
const AROUND = 40;

/** All that is said at one moment, on the screen and in the headset alike. */
export interface Said {
  /** `card`: the view rests; `count`: it is about to begin; `play`: the view is free, the line is below it. */
  readonly layout: "card" | "count" | "play";
  /** Which episode this is, such as "Practice 1 of 2". */
  readonly heading: string;
  /** The one sentence. */
  readonly line: string;
  /** Keys or movements, below the sentence; may be empty. */
  readonly hint: string;
  readonly actions: readonly Action[];
}

export class Hud {
  readonly element: HTMLElement;
  readonly #heading = h("p", { class: "count" });
  readonly #left = h("p", { class: "left" });
  readonly #bar = h("span", {});
  readonly #alert = h("p", { class: "alert", hidden: true });
  readonly #line = h("p", { class: "line" });
  readonly #hint = h("p", { class: "hint" });
  readonly #card = h("div", { class: "play-card" });
  readonly #top: HTMLElement;
  readonly #bottom: HTMLElement;
  #said: Said | null = null;
  #warned = -Infinity;

  constructor(private readonly announce: (message: string) => void, turns: HTMLElement) {
    this.#top = h("div", { class: "hud top" }, this.#heading,
      h("div", { class: "progress", "aria-hidden": "true" }, this.#bar), this.#left);
    this.#bottom = h("div", { class: "hud bottom" }, this.#alert, this.#line, this.#hint, turns);
    this.element = h("div", { class: "hud-all" }, this.#top, this.#card, this.#bottom);
  }

  /** Says something else; the keyboard goes to the first thing to do. */
  say(said: Said): void {
    this.#said = said;
    const isCard = said.layout !== "play";
    this.element.dataset["layout"] = said.layout;
    this.#heading.textContent = said.heading;
    this.#line.textContent = isCard ? "" : said.line;
    this.#hint.textContent = isCard ? "" : said.hint;
    this.#card.hidden = !isCard;
    this.#card.replaceChildren(...(isCard ? this.#cardOf(said) : []));
    this.announce([said.line, said.hint].filter(Boolean).join(" "));
    if (isCard) (this.#card.querySelector<HTMLElement>("button.primary") ?? this.#card.querySelector("button"))?.focus();
  }

  /** How far the card reaches over the middle of the picture, where hand, robot and goal are [px]. */
  get hides(): number {
    if (this.#card.hidden) return 0;
    const [all, card] = [this.element.getBoundingClientRect(), this.#card.getBoundingClientRect()];
    return Math.max(0, Math.min(all.height / 4, (all.top + all.bottom) / 2 + AROUND - card.top));
  }

  get said(): Said | null {
    return this.#said;
  }

  #cardOf({ heading, line, hint, actions }: Said): HTMLElement[] {
    return [
      h("p", { class: "card-heading" }, heading), h("h1", {}, line), h("p", { class: "card-hint", hidden: hint === "" }, hint),
      h("div", { class: actions.length > 2 ? "actions column" : "actions" }, ...actions.map((action) =>
        button(action.label, () => action.run(), { class: action.primary ? "primary" : null, "data-action": action.id }))),
    ];
  }

  /** Time left [s] of `whole`; null while nothing runs. */
  time(left: number | null, whole: number, text: string): void {
    this.#top.dataset["running"] = String(left !== null);
    this.#bar.style.width = left === null ? "0" : `${(100 * left) / whole}%`;
    if (this.#left.textContent !== text) this.#left.textContent = text;
  }

  /** Something that is so right now, with a sign and words, never by colour alone. */
  alert(text: string | null): void {
    this.#alert.hidden = text === null;
    if (text !== null && this.#alert.textContent !== text) this.#alert.textContent = text;
    if (text !== null && !this.element.classList.contains("touched") && performance.now() - this.#warned > QUIET) {
      this.#warned = performance.now();
      this.announce(text);
    }
    this.element.classList.toggle("touched", text !== null);
  }
}
