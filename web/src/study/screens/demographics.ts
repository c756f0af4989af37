/** Questions about the participant, each free to skip. The server says which there are. */
import { button, h, on } from "../../base/dom.js";
import { dict, list, number, text, type Dict } from "../../base/read.js";
import type { Mount, Words } from "../context.js";
import { sending } from "./sending.js";

interface Field {
  readonly element: HTMLElement;
  /** The answer; undefined where it was skipped. */
  value(): string | number | undefined;
}

/** A choice of one; a second click on the chosen one takes it back. */
function choice(id: string, label: string, options: readonly (readonly [string, string])[], ends = ""): Field {
  const inputs = options.map(([value]) => {
    const input = h("input", { type: "radio", name: id, value, id: `${id}-${value}` });
    let was = false;
    return on(input, {
      pointerdown: () => (was = input.checked),
      click: () => {
        if (was) input.checked = false;
        was = false;
      },
    });
  });
  const hint = ends && h("span", { class: "hint", id: `${id}-hint` }, ends);
  const element = h("fieldset", { class: ends ? "question scale" : "question", "aria-describedby": ends ? `${id}-hint` : null },
    h("legend", {}, label), hint,
    h("div", { class: "options" }, ...options.map(([value, name], i) =>
      h("label", { class: "option", for: `${id}-${value}` }, inputs[i], h("span", {}, name)))));
  return { element, value: () => inputs.find(({ checked }) => checked)?.value };
}

function numeric(field: Field): Field {
  return {
    element: field.element,
    value: () => {
      const chosen = field.value();
      return chosen === undefined ? undefined : Number(chosen);
    },
  };
}

function line(id: string, label: string, attributes: Record<string, string | number>, asNumber: boolean): Field {
  const input = h("input", { id, autocomplete: "off", ...attributes });
  return {
    element: h("div", { class: "question" }, h("label", { for: id }, label), input),
    value: () => (input.value.trim() === "" ? undefined : asNumber ? Number(input.value) : input.value.trim()),
  };
}

function fieldOf(question: Dict, words: Words): Field {
  const id = text(question["id"]);
  const label = words(`demographics.${id}.label`);
  const options = list(question["options"]).map((value) => text(value));
  if (options.length > 0) {
    return choice(id, label, options.map((value) => [value, words(`demographics.${id}.options.${value}`)] as const));
  }
  const scale = dict(question["scale"]);
  const [low, high] = [number(scale["min"]), number(scale["max"])];
  if (low !== null && high !== null) {
    const steps = Array.from({ length: high - low + 1 }, (_, i) => String(low + i));
    return numeric(choice(id, label, steps.map((step) => [step, step] as const), words(`demographics.${id}.ends`)));
  }
  if ("number" in question) {
    const { min, max } = dict(question["number"]);
    return line(id, label, { type: "number", inputmode: "numeric", min: text(min), max: text(max), step: 1 }, true);
  }
  return line(id, label, { type: "text", maxlength: text(dict(question["text"])["max"], "100") }, false);
}

export const mountDemographics: Mount = (root, { api, words, state, proceed, announce }) => {
  const fields = list(state.stage["questions"]).map(dict).map((question) => ({
    id: text(question["id"]), field: fieldOf(question, words),
  }));
  const answers = (): Dict => Object.fromEntries(
    fields.map(({ id, field }) => [id, field.value()] as const).filter(([, value]) => value !== undefined));
  const send = (given: Dict): Promise<void> =>
    sending(form, words, announce, async () => proceed(await api.post("demographics", given)));
  const form = on(h("form", {}, ...fields.map(({ field }) => field.element),
    h("div", { class: "actions" },
      h("button", { type: "submit", class: "primary" }, words("shell.next")),
      button(words("demographics.skip"), () => void send({}), { class: "quiet" }))), {
    submit: (event) => {
      event.preventDefault();
      void send(answers());
    },
  });
  root.append(h("div", { class: "card reading" },
    h("h1", {}, words("demographics.title")), h("p", {}, words("demographics.says")), form));
  return { dispose: () => undefined };
};
