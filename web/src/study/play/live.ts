/** The socket of live play: starts episodes, sends targets, connects again when it was cut. */
import { dict, number, numbers, text, type Dict } from "../../base/read.js";
import type { Clip, Vector } from "../../replay/clip.js";
import { readFrame, type Frame } from "./frame.js";
import type { LiveSettings } from "./live-clip.js";
import type { Reach } from "./target.js";

/** Between two targets [ms]: twice the control rate; the server takes at most 30 a second. Ours. */
const TARGET_EVERY = 50;
const PING_EVERY = 2000; // [ms] Ours.
/** Pings are answered: after so many without a word the line is cut, whatever the browser thinks of it. Ours. */
const UNANSWERED = 4;
const WAITS = [300, 700, 1500, 3000]; // [ms] before another try; the last one for ever. Ours.
const WRONG_LINK = 4401;
const ELSEWHERE = 4409;

/** An episode that the server began. */
export interface Begun {
  readonly number: number;
  readonly of: number;
  readonly settings: LiveSettings;
  readonly reach: Reach;
  readonly hand: Vector;
}

export interface LiveHandlers {
  /** The connection stands. */
  connected(): void;
  begun(episode: Begun): void;
  frame(frame: Frame): void;
  finished(): void;
  /** Another try follows by itself. */
  lost(): void;
  /** No other try: the link is wrong, or the study is open elsewhere. */
  closed(why: "link" | "elsewhere"): void;
  refused(reason: string): void;
}

function vector(value: unknown, otherwise: Vector): Vector {
  const [x, y, z] = numbers(value);
  return x !== undefined && y !== undefined && z !== undefined && Number.isFinite(x + y + z) ? [x, y, z] : otherwise;
}

function goalOf(value: unknown): Clip["itch"] {
  const raw = dict(value);
  const body = number(raw["body"]);
  return body === null ? null : { body, pos: vector(raw["pos"], [0, 0, 0]), limb: text(raw["limb"]) };
}

/** Reads the message that begins an episode; null where it makes no sense. */
export function readBegun(raw: Dict): Begun | null {
  const bodies = numbers(raw["bodies"]);
  const [substeps, period, horizon] = [number(raw["substeps"]), number(raw["period"]), number(raw["horizon"])];
  if (!substeps || !period || !horizon || bodies.length === 0) return null;
  const hand = vector(raw["hand"], [0, 0, 0]);
  const reach = dict(raw["reach"]);
  return {
    number: number(raw["number"]) ?? 0,
    of: number(raw["of"]) ?? 1,
    settings: { bodies, substeps, period, horizon, goal: goalOf(raw["goal"]) },
    reach: { shoulder: vector(reach["shoulder"], hand), radius: number(reach["radius"]) ?? 0.7 },
    hand,
  };
}

export class Live {
  #socket: WebSocket | null = null;
  #n = 0;
  #tries = 0;
  #retry = 0;
  #pings = 0;
  #unanswered = 0;
  #sent: { at: number; position: Vector } = { at: -Infinity, position: [NaN, NaN, NaN] };
  #over = false;
  /** Of the last ping, there and back [ms]; null before the first. */
  roundTrip: number | null = null;

  constructor(private readonly url: string, private readonly handlers: LiveHandlers) {
    this.#connect();
  }

  get connected(): boolean {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /** Asks for the next episode. */
  start(device: string, about: Dict): void {
    this.#sent = { at: -Infinity, position: [NaN, NaN, NaN] };
    this.#send({ type: "start", device, about });
  }

  /** Tells where the hand shall go; too quick repetitions are left out. */
  target(step: number, position: Vector, now: number): void {
    if (now - this.#sent.at < TARGET_EVERY || position.every((v, i) => v === this.#sent.position[i])) return;
    this.#sent = { at: now, position };
    this.#send({ type: "target", step, position });
  }

  /** Ends the running episode; the participant wants to stop. */
  stop(): void {
    this.#send({ type: "stop" });
  }

  dispose(): void {
    this.#over = true;
    clearTimeout(this.#retry);
    clearInterval(this.#pings);
    this.#socket?.close();
  }

  #send(message: Dict): void {
    if (this.connected) this.#socket?.send(JSON.stringify({ ...message, n: ++this.#n }));
  }

  #connect(): void {
    clearTimeout(this.#retry);
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    this.#socket = socket;
    this.#n = 0;
    this.#unanswered = 0;
    clearInterval(this.#pings);
    this.#pings = window.setInterval(() => this.#ping(socket), PING_EVERY);
    socket.addEventListener("open", () => {
      this.#tries = 0;
      this.#ping(socket);
      this.handlers.connected();
    });
    socket.addEventListener("message", ({ data }) => {
      this.#unanswered = 0;
      if (socket === this.#socket) this.#take(data as unknown);
    });
    socket.addEventListener("close", ({ code }) => this.#closed(socket, code));
  }

  /** Asks whether the server is there; gives up a connection of which nothing is heard any more. */
  #ping(socket: WebSocket): void {
    if (this.#unanswered++ < UNANSWERED) return this.#send({ type: "ping", sent: performance.now() });
    socket.close();
    this.#closed(socket, 1006); // The browser would wait much longer for the other side's farewell.
  }

  #closed(socket: WebSocket, code: number): void {
    if (this.#over || socket !== this.#socket) return;
    this.#socket = null;
    clearInterval(this.#pings);
    if (code === WRONG_LINK || code === ELSEWHERE) {
      this.handlers.closed(code === ELSEWHERE ? "elsewhere" : "link");
      return;
    }
    this.handlers.lost();
    this.#retry = window.setTimeout(() => this.#connect(), WAITS[Math.min(this.#tries++, WAITS.length - 1)]);
  }

  #take(data: unknown): void {
    if (data instanceof ArrayBuffer) {
      const frame = readFrame(data);
      if (frame) this.handlers.frame(frame);
      return;
    }
    const raw = parsed(data);
    switch (raw["type"]) {
      case "episode": {
        const begun = readBegun(raw);
        if (begun) this.handlers.begun(begun);
        break;
      }
      case "finished":
        this.handlers.finished();
        break;
      case "pong":
        this.roundTrip = performance.now() - (number(raw["sent"]) ?? NaN);
        break;
      case "refused":
        this.handlers.refused(text(raw["reason"]));
        break;
    }
  }
}

function parsed(data: unknown): Dict {
  try {
    return dict(JSON.parse(text(data)));
  } catch {
    return {};
  }
}

