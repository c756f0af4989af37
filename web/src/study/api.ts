/** The server's HTTP side, as `context.ts` promises it: waits out a lost connection. */
import { dict, list, number, text, type Dict } from "../base/read.js";
import { Signal } from "../base/signal.js";
import { readClip, readScene, type Clip, type Scene } from "../replay/clip.js";
import { Refused, type Api, type State } from "./context.js";

const WAITS = [500, 1000, 2000, 4000]; // [ms] between tries; the last one for ever. Ours.
/** Within so long [ms] even a slow line has brought an answer; a line that is cut brings none. Ours. */
const LONGEST = 60_000;
const BUSY = new Set([429, 502, 503, 504]);

/** Reads a state; whatever is missing has a harmless value. */
export function readState(value: unknown): State {
  const raw = dict(value);
  const participant = dict(raw["participant"]);
  return {
    title: text(raw["title"]),
    language: text(raw["language"], "en"),
    participant: { code: text(participant["code"]), role: text(participant["role"]) },
    before: list(raw["before"]).map((kind) => text(kind)),
    stages: list(raw["stages"]).map((entry, index) => {
      const stage = dict(entry);
      return { kind: text(stage["kind"]), index: number(stage["index"]) ?? index };
    }),
    stage: dict(raw["stage"]),
    canStop: raw["can_stop"] !== false,
  };
}

/** The server behind `/p/<token>`. */
export class Server implements Api {
  /** Whether the last try reached the server. */
  readonly reached = new Signal(true);
  readonly #base: string;
  readonly #clips = new Map<string, Promise<Clip | null>>();
  #scene: Promise<Scene | null> | null = null;

  constructor(location: Location) {
    const path = /^.*?\/p\/[^/]+/.exec(location.pathname)?.[0] ?? "";
    this.#base = `${location.origin}${path}`;
  }

  /** Where live episodes are played. */
  get live(): string {
    return `${this.#base.replace(/^http/, "ws")}/live`;
  }

  async state(): Promise<State> {
    return readState(await this.#ask("state"));
  }

  async texts(): Promise<unknown> {
    return this.#ask("texts");
  }

  async post(route: string, body: Dict): Promise<State> {
    const headers = { "Content-Type": "application/json" };
    return readState(await this.#ask(route, { method: "POST", headers, body: JSON.stringify(body) }));
  }

  scene(): Promise<Scene | null> {
    this.#scene ??= this.#ask("scene").then(readScene);
    return this.#scene;
  }

  clip(key: string): Promise<Clip | null> {
    const known = this.#clips.get(key);
    if (known) return known;
    const asked = this.#ask(`clip/${encodeURIComponent(key)}`).then(readClip);
    this.#clips.set(key, asked);
    asked.catch(() => this.#clips.delete(key));
    return asked;
  }

  async #ask(route: string, init: RequestInit = {}): Promise<unknown> {
    for (let attempt = 0; ; attempt++) {
      const answer = await this.#try(`${this.#base}/api/${route}`, init);
      if (answer) {
        this.reached.value = true;
        return answer.said;
      }
      if (attempt > 0) this.reached.value = false;
      await new Promise((go) => setTimeout(go, WAITS[Math.min(attempt, WAITS.length - 1)]));
    }
  }

  /** The answer, all of it; null where there was none, or the server is busy. */
  async #try(url: string, init: RequestInit): Promise<{ readonly said: unknown } | null> {
    let answer: Response;
    try {
      const signal = AbortSignal.timeout(LONGEST);
      answer = await fetch(url, { ...init, signal, cache: "no-store", credentials: "same-origin" });
      if (answer.ok) return { said: await answer.json() };
    } catch {
      return null;
    }
    if (BUSY.has(answer.status)) return null;
    const told = dict(await answer.json().catch(() => null));
    throw new Refused(answer.status, text(told["error"], "refused"), text(told["message"], answer.statusText));
  }
}
