/** What the hand can be moved with here, and what was chosen last time. */
export type Way = "mouse" | "keyboard" | "touch" | "vr";

const KEY = "rigid-study-way";

/** The ways that this browser offers, the most natural one first. */
export async function waysHere(): Promise<Way[]> {
  const ways: Way[] = [];
  const isHeadset = await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false);
  if (isHeadset) ways.push("vr");
  const touches = matchMedia("(any-pointer: coarse)").matches || navigator.maxTouchPoints > 0;
  const points = matchMedia("(any-pointer: fine)").matches;
  if (touches && !points) ways.push("touch");
  if (points || !touches) ways.push("mouse", "keyboard");
  if (touches && points) ways.push("touch");
  if (touches && !points) ways.push("keyboard");
  return ways;
}

/** The way of this participant's practice, if this browser remembers one. */
export function rememberedWay(code: string, ways: readonly Way[]): Way | null {
  try {
    const stored = localStorage.getItem(`${KEY}:${code}`);
    return ways.find((way) => way === stored) ?? null;
  } catch {
    return null; // A browser that stores nothing forgets; it asks again.
  }
}

export function rememberWay(code: string, way: Way): void {
  try {
    localStorage.setItem(`${KEY}:${code}`, way);
  } catch {
    // See above.
  }
}

/** What the browser says of itself, kept with the episode: to tell slow devices apart. */
export function aboutDevice(roundTrip: number | null, framesPerSecond: number | null): Record<string, string | number | null> {
  return {
    screen: `${innerWidth}x${innerHeight}@${Math.round(100 * devicePixelRatio) / 100}`,
    agent: navigator.userAgent.slice(0, 300),
    round_trip_ms: roundTrip === null ? null : Math.round(roundTrip),
    frames_per_second: framesPerSecond === null ? null : Math.round(framesPerSecond),
  };
}
