/** The last screens: done, stopped, withdrawn. */
import { button, h } from "../../base/dom.js";
import { text } from "../../base/read.js";
import type { Mount, StudyContext } from "../context.js";
import { sending } from "./sending.js";

/** Deleting what was stored stays possible at the end. */
function deletion({ api, words, proceed, announce }: StudyContext): HTMLElement {
  const asked = (now: boolean): void => {
    sure.hidden = !now;
    ask.setAttribute("aria-expanded", String(now));
    (now ? sure.querySelector("p") : ask)?.focus();
  };
  const sure = h("div", { hidden: true },
    h("p", { tabindex: -1 }, words("leave.sure-says")),
    h("div", { class: "actions" },
      button(words("leave.delete"), () => void sending(part, words, announce, async () =>
        proceed(await api.post("withdraw", { confirm: "withdraw" }))), { class: "danger" }),
      button(words("ending.keep"), () => asked(false))));
  const ask = button(words("ending.withdraw"), () => asked(true), { class: "quiet", "aria-expanded": "false" });
  const part = h("section", { class: "deletion" },
    h("p", { class: "soft" }, words("ending.withdraw-says")), h("div", { class: "actions" }, ask), sure);
  return part;
}

function yourCode({ words, state }: StudyContext): HTMLElement {
  return h("p", { class: "soft" }, words("ending.pseudonym", { code: state.participant.code }));
}

export const mountDone: Mount = (root, context) => {
  const { words, state } = context;
  const [code, url] = [text(state.stage["code"]), text(state.stage["url"])];
  const copied = h("span", { class: "soft", role: "status" });
  const copy = button(words("ending.copy"), () => {
    void navigator.clipboard.writeText(code).then(() => (copied.textContent = words("ending.copied")));
  });
  root.append(h("div", { class: "card" },
    h("h1", {}, words("ending.done")), h("p", {}, words("ending.done-says")),
    code && h("div", { class: "completion" },
      h("p", {}, words("ending.code")), h("p", { class: "code" }, code),
      isSecureContext && h("div", { class: "actions" }, copy, copied)),
    url && /^https?:\/\//.test(url) && h("div", { class: "actions" },
      h("a", { class: "button primary", href: url, rel: "noreferrer" }, words("ending.back"))),
    yourCode(context), deletion(context)));
  return { dispose: () => undefined };
};

export const mountStopped: Mount = (root, context) => {
  const { words } = context;
  root.append(h("div", { class: "card" },
    h("h1", {}, words("ending.stopped")), h("p", {}, words("ending.stopped-says")), yourCode(context), deletion(context)));
  return { dispose: () => undefined };
};

export const mountWithdrawn: Mount = (root, { words }) => {
  root.append(h("div", { class: "card" },
    h("h1", {}, words("ending.withdrawn")), h("p", {}, words("ending.withdrawn-says"))));
  return { dispose: () => undefined };
};
