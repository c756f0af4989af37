/** The page's words in one language, and simple formatted texts of the study's authors. */
import { h } from "../base/dom.js";
import { dict, list, text } from "../base/read.js";
import type { Words } from "./context.js";

type Values = Readonly<Record<string, string | number>>;

/** Makes the lookup for the texts of a language. */
export function wordsOf(texts: unknown, language: string): Words {
  const plural = pluralOf(language);
  const find = (path: string): unknown => path.split(".").reduce<unknown>((at, key) => dict(at)[key], texts);
  const words = (path: string, values: Values = {}): string => {
    const found = find(path);
    const forms = dict(found);
    const chosen = typeof found === "string" ? found
      : text(forms[plural(Number(values["count"]))], text(forms["other"], path));
    return chosen.replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
  };
  return Object.assign(words, { list: (path: string) => list(find(path)).map((item) => text(item)) });
}

function pluralOf(language: string): (count: number) => string {
  const rules = new Intl.PluralRules(Intl.PluralRules.supportedLocalesOf(language).length ? language : "en");
  return (count) => rules.select(count);
}

/**
 * Text with `#` headings, `-` items, **bold** and blank lines between paragraphs, as elements.
 * Nothing else is markup: foreign text stays text. The smallest heading is `<h2>`.
 */
export function prose(source: string): HTMLElement {
  const blocks = source.replace(/\r/g, "").split(/\n\s*\n/).map((block) => block.trim()).filter(Boolean);
  return h("div", { class: "prose" }, ...blocks.flatMap(blockOf));
}

function blockOf(block: string): HTMLElement[] {
  const [first = "", ...rest] = block.split("\n");
  const heading = /^(#{1,4})\s+(.*)$/.exec(first);
  if (heading) {
    const tag = (heading[1] ?? "").length <= 2 ? "h2" : "h3";
    return [h(tag, {}, ...inline(heading[2] ?? "")), ...(rest.length ? blockOf(rest.join("\n")) : [])];
  }
  const item = /^\s*[-*]\s+/;
  if (!item.test(first)) return [h("p", {}, ...inline(block.replaceAll("\n", " ")))];
  const items = block.split(/\n(?=\s*[-*]\s+)/).map((line) => line.replace(item, "").replaceAll("\n", " "));
  return [h("ul", {}, ...items.map((line) => h("li", {}, ...inline(line))))];
}

function inline(line: string): (Node | string)[] {
  return line.split(/\*\*(.+?)\*\*/).map((part, index) => (index % 2 ? h("b", {}, part) : part));
}
