/**
 * What every screen of the participant's page is given, and what it gives back. The shell
 * (`main.ts`) mounts one screen for the stage that the server names, disposes of it when the stage
 * is over, and mounts the next.
 */
import type { Dict } from "../base/read.js";
import type { Clip, Scene } from "../replay/clip.js";

/** What a screen returns: takes its listeners, timers, sockets and 3D views away again. */
export interface Disposable {
  dispose(): void;
  /** Where a screen serves several stages in a row (practise, play): takes the next one's state. */
  update?(state: State): void;
  /** The participant thinks about stopping: whatever moves or counts time must rest. */
  pause?(): void;
  /** They go on. */
  resume?(): void;
}

/**
 * Words of the page's language (`rigid/study/texts/<language>.json`), by dotted path. `{name}` in a
 * text is replaced by `values.name`; where the file holds `{"one": …, "other": …}`, `values.count`
 * decides. An unknown path gives the path itself, so that a gap is seen and breaks nothing.
 */
export interface Words {
  (path: string, values?: Readonly<Record<string, string | number>>): string;
  /** Several paragraphs or items: the texts of a list; [] where there is none. */
  list(path: string): readonly string[];
}

/** The state of the participant, as `GET api/state` and every POST return it. */
export interface State {
  readonly title: string;
  readonly language: string;
  readonly participant: { readonly code: string; readonly role: string };
  /** Kinds of what comes before the stages. */
  readonly before: readonly string[];
  readonly stages: readonly { readonly kind: string; readonly index: number }[];
  /** Its `kind` says which screen it is; the screen reads the rest (`base/read.ts`). */
  readonly stage: Dict;
  readonly canStop: boolean;
}

/** An answer of the server that is no state. */
export class Refused extends Error {
  constructor(readonly status: number, readonly code: string, message: string) {
    super(message);
  }
}

export interface Api {
  /**
   * Sends `body` as JSON to `api/<route>`; returns the new state. While the connection is gone it
   * tries again by itself, and the page says so: resolves late rather than fails.
   *
   * @throws Refused The server answered that it does not take this.
   */
  post(route: string, body: Dict): Promise<State>;
  /** Where the participant stands now. */
  state(): Promise<State>;
  /** Address of the socket of live play. */
  readonly live: string;
  /** The scene of the task, or null where there is nothing to draw. Fetched once. */
  scene(): Promise<Scene | null>;
  /** A replay by its opaque key, or null where it is damaged. Kept once fetched. */
  clip(key: string): Promise<Clip | null>;
}

export interface StudyContext {
  readonly api: Api;
  readonly words: Words;
  readonly state: State;
  /** Says something to screen readers without moving the focus. */
  announce(message: string): void;
  /** Takes a new state and goes where it leads; the screen is disposed of if its stage is over. */
  proceed(state: State): void;
}

/** Every screen: fills the empty `root`. Called once per stage (and again after a reload). */
export type Mount = (root: HTMLElement, context: StudyContext) => Disposable;

/*
 * Questionnaires: `judge/main.ts` exports
 *
 *   export const mountJudge: Mount
 *
 * `context.state.stage` is the server's `{"kind": "judge", …}`. Per answer it calls
 * `context.api.post("answer", …)` and keeps the state it gets; when no trial is left it calls
 * `context.proceed(state)` with the last one. Texts live in the section `judge`, as
 * `context.words("judge.…")`. Style sheets are imported from TypeScript (`import "./judge.css"`) and
 * land in study.css. The content policy forbids style attributes in markup: set `element.style`.
 */
