/** Welcome, and what participants agree to. Nothing is stored before they do. */
import { button, h, on } from "../../base/dom.js";
import { text } from "../../base/read.js";
import type { Mount } from "../context.js";
import { prose } from "../words.js";
import { sending } from "./sending.js";

export const mountConsent: Mount = (root, { api, words, state, proceed, announce }) => {
  const { stage } = state;
  const agreed = h("input", { type: "checkbox", id: "agreed", required: true });
  const shared = h("input", { type: "checkbox", id: "shared" });
  const problem = h("p", { class: "problem", id: "consent-problem", role: "alert" });
  const form = h("form", { novalidate: true },
    h("label", { class: "check", for: "agreed" }, agreed, h("span", {}, words("consent.agree"))),
    stage["sharing"] === true
      && h("label", { class: "check", for: "shared" }, shared, h("span", {}, words("consent.share"))),
    problem,
    h("div", { class: "actions" },
      h("button", { type: "submit", class: "primary" }, words("consent.begin")),
      button(words("consent.decline"), () => decline(), { class: "quiet" })));
  const declined = h("div", { hidden: true },
    h("p", { tabindex: -1 }, words("consent.declined")),
    h("div", { class: "actions" }, button(words("consent.reconsider"), () => decline(false))));
  const decline = (away = true): void => {
    [form.hidden, declined.hidden] = [away, !away];
    (away ? declined.querySelector("p") : agreed)?.focus();
  };
  on(form, {
    submit: (event) => {
      event.preventDefault();
      if (!agreed.checked) {
        problem.textContent = words("consent.needed");
        agreed.setAttribute("aria-describedby", problem.id);
        agreed.focus();
        return;
      }
      void sending(form, words, announce, async () => proceed(await api.post("consent", {
        version: text(stage["version"]), agreed: true, sharing: shared.checked,
      })));
    },
  });
  on(agreed, { change: () => (problem.textContent = "") });
  const contact = text(stage["contact"]);
  root.append(h("div", { class: "card reading" },
    h("h1", {}, state.title),
    prose(text(stage["text"]) || words.list("consent.text").join("\n\n")),
    contact && h("p", { class: "contact" }, words("consent.contact", { contact })),
    form, declined));
  return { dispose: () => undefined };
};
