/**
 * One recorded episode and the scene it moves: poses decoded from the page, and what happened.
 *
 * Poses are little-endian int16 of shape [frames, bodies, 7]: position in units of 1e-4 m, then the
 * quaternion w, x, y, z in units of 1/32767.
 */
import { dict, list, number, numbers, text } from "../base/read.js";

export const POSITION_UNIT = 1e-4;
export const QUATERNION_UNIT = 1 / 32767;

export type Vector = readonly [number, number, number];
export type Quaternion = readonly [w: number, x: number, y: number, z: number];

export interface Geom {
  readonly name: string;
  readonly body: number;
  readonly type: string;
  readonly size: readonly number[];
  readonly pos: Vector;
  readonly quat: Quaternion;
  readonly rgba: readonly [number, number, number, number];
  readonly role: string;
}

export interface Pose {
  readonly position: Vector;
  readonly rotation: Quaternion;
}

export interface Scene {
  readonly bodies: readonly string[];
  readonly geoms: readonly Geom[];
  /** Where bodies stand that no episode moves; the world's origin where nothing is said. */
  readonly rest: readonly Pose[];
  /** What the tool is to reach, in a word. */
  readonly goal: string;
}

const ORIGIN: Pose = { position: [0, 0, 0], rotation: [1, 0, 0, 0] };

export type ContactKind = "itch" | "other" | "unwanted";

export interface Contact {
  readonly frame: number;
  readonly at: Vector;
  readonly force: number;
  readonly kind: ContactKind;
}

export interface Clip {
  readonly seed: number;
  readonly dt: number;
  readonly frames: number;
  readonly bodies: readonly number[];
  readonly poses: Float32Array;
  readonly itch: { readonly body: number; readonly pos: Vector; readonly limb: string } | null;
  readonly forceUnwanted: readonly number[];
  readonly forceItch: readonly number[];
  readonly distance: readonly number[];
  /** Counted contacts so far; empty in a task that counts none. */
  readonly counted: readonly number[];
  /** Pieces of food eaten, and fallen, so far; in a task with food. */
  readonly eaten?: readonly number[];
  readonly spilled?: readonly number[];
  readonly contacts: readonly Contact[];
  readonly return: number | null;
  readonly success: boolean | null;
  readonly outcome: string;
  /** What went wrong, and when; null where nothing did, or nothing is known. */
  readonly failure: { readonly frame: number; readonly says: string } | null;
}

const KINDS: readonly ContactKind[] = ["itch", "other", "unwanted"];

function vector(value: unknown): Vector {
  const [x = 0, y = 0, z = 0] = numbers(value).map((v) => (Number.isFinite(v) ? v : 0));
  return [x, y, z];
}

function quaternion(value: unknown): Quaternion {
  const [w, x, y, z] = numbers(value);
  const known = [w, x, y, z].every((v) => v !== undefined && Number.isFinite(v));
  return known ? [w as number, x as number, y as number, z as number] : [1, 0, 0, 0];
}

function readGeom(value: unknown): Geom {
  const raw = dict(value);
  const [r = 0.6, g = 0.6, b = 0.6, a = 1] = numbers(raw["rgba"]);
  return {
    name: text(raw["name"]),
    body: number(raw["body"]) ?? 0,
    type: text(raw["type"]),
    size: numbers(raw["size"]),
    pos: vector(raw["pos"]),
    quat: quaternion(raw["quat"]),
    rgba: [r, g, b, a],
    role: text(raw["role"]),
  };
}

/** The scene, or null where none was stored. */
export function readScene(value: unknown): Scene | null {
  const raw = dict(value);
  const geoms = list(raw["geoms"]).map(readGeom);
  const bodies = list(raw["bodies"]).map((name) => text(name));
  const rest = list(raw["rest"]).map((pose) => {
    const values = list(pose);
    return { position: vector(values.slice(0, 3)), rotation: quaternion(values.slice(3, 7)) };
  });
  return geoms.length === 0 ? null : { bodies, geoms, rest, goal: text(raw["goal"], "itch") };
}

/** Where a body stands that no episode moves. */
export function restOf(scene: Scene, body: number): Pose {
  return scene.rest[body] ?? ORIGIN;
}

/** Base64 → metres and unit quaternions, [frames · bodies · 7]; null when the text is not that. */
export function decodePoses(base64: string, values: number): Float32Array | null {
  let bytes: string;
  try {
    bytes = atob(base64);
  } catch {
    return null;
  }
  if (bytes.length !== 2 * values) return null;
  const view = new DataView(Uint8Array.from(bytes, (c) => c.charCodeAt(0)).buffer);
  return Float32Array.from({ length: values }, (_, i) => {
    const unit = i % 7 < 3 ? POSITION_UNIT : QUATERNION_UNIT;
    return view.getInt16(2 * i, true) * unit;
  });
}

function readContact(value: unknown): Contact[] {
  const [frame, x, y, z, force, kind] = numbers(value);
  if (frame === undefined || x === undefined || y === undefined || z === undefined) return [];
  if (![frame, x, y, z].every(Number.isFinite)) return [];
  return [{ frame, at: [x, y, z], force: force ?? NaN, kind: KINDS[kind ?? 1] ?? "other" }];
}

function readItch(value: unknown): Clip["itch"] {
  const raw = dict(value);
  const body = number(raw["body"]);
  return body === null ? null : { body, pos: vector(raw["pos"]), limb: text(raw["limb"]) };
}

function readFailure(value: unknown): Clip["failure"] {
  const raw = dict(value);
  const frame = number(raw["frame"]);
  return frame === null ? null : { frame, says: text(raw["says"]) };
}

/** An episode, or null where none was stored or its poses are damaged. */
export function readClip(value: unknown): Clip | null {
  const raw = dict(value);
  const bodies = numbers(raw["bodies"]);
  const frames = number(raw["frames"]) ?? 0;
  const poses = decodePoses(text(raw["poses"]), frames * bodies.length * 7);
  if (!poses || frames < 1) return null;
  return {
    seed: number(raw["seed"]) ?? NaN,
    dt: number(raw["dt"]) ?? 0.1,
    frames,
    bodies,
    poses,
    itch: readItch(raw["itch"]),
    forceUnwanted: numbers(raw["force_unwanted"]),
    forceItch: numbers(raw["force_itch"]),
    distance: numbers(raw["distance"]),
    counted: numbers(raw["counted"]),
    eaten: numbers(raw["eaten"]),
    spilled: numbers(raw["spilled"]),
    contacts: list(raw["contacts"]).flatMap(readContact),
    return: number(raw["return"]),
    success: typeof raw["success"] === "boolean" ? raw["success"] : null,
    outcome: text(raw["outcome"]),
    failure: readFailure(raw["failure"]),
  };
}
