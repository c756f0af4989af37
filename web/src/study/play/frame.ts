/**
 * One message of a live episode, as `rigid.study.play.frame` writes it (little endian): u32 step,
 * u8 flags (1 unwanted contact, 2 done), u8 substeps, u16 bodies, u16 counted, u16 reserved,
 * 3 × f32 hand, then the poses of every physics substep as in replays (`replay/clip.ts`).
 */
import { POSITION_UNIT, QUATERNION_UNIT, type Vector } from "../../replay/clip.js";

const HEADER = 24; // [bytes]
const UNWANTED = 1;
const DONE = 2;

export interface Frame {
  /** Control steps done; 0 for the start, which has one substep. */
  readonly step: number;
  readonly unwanted: boolean;
  readonly done: boolean;
  readonly substeps: number;
  readonly bodies: number;
  /** Contacts counted by the task so far. */
  readonly counted: number;
  /** Where the played hand is [m]. */
  readonly hand: Vector;
  /** [substeps · bodies · 7]: metres, then the quaternion w, x, y, z. */
  readonly poses: Float32Array;
}

/** The frame in a message, or null where the message is none. */
export function readFrame(message: ArrayBuffer): Frame | null {
  if (message.byteLength < HEADER) return null;
  const view = new DataView(message);
  const flags = view.getUint8(4);
  const substeps = view.getUint8(5);
  const bodies = view.getUint16(6, true);
  const values = substeps * bodies * 7;
  if (substeps === 0 || message.byteLength !== HEADER + 2 * values) return null;
  const hand = [0, 1, 2].map((axis) => view.getFloat32(12 + 4 * axis, true));
  if (!hand.every(Number.isFinite)) return null;
  const poses = Float32Array.from({ length: values }, (_, i) =>
    view.getInt16(HEADER + 2 * i, true) * (i % 7 < 3 ? POSITION_UNIT : QUATERNION_UNIT));
  return {
    step: view.getUint32(0, true),
    unwanted: (flags & UNWANTED) !== 0,
    done: (flags & DONE) !== 0,
    substeps,
    bodies,
    counted: view.getUint16(8, true),
    hand: hand as unknown as Vector,
    poses,
  };
}
