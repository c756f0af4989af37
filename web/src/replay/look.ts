/** Colours of the 3D view, taken from the page's theme so that both change together. */
import { Color } from "three";
import { themeColor } from "../base/theme.js";
import type { Geom } from "./clip.js";

export interface Look {
  readonly roles: Readonly<Record<string, Color>>;
  readonly unwanted: Color;
  readonly other: Color;
  readonly itch: Color;
  readonly tip: Color;
  readonly ghost: Color;
  readonly grid: Color;
  readonly shadow: number;
  readonly sky: number;
}

const ROLES = ["robot", "human", "chair", "tool"] as const;

/** How much of a geom's own colour shows through its role's. */
const OWN_SHARE = 0.4;

/** Reads the look that the page has now. */
export function currentLook(dark: boolean): Look {
  const color = (name: string): Color => new Color(themeColor(`--3d-${name}`));
  return {
    roles: Object.fromEntries(ROLES.map((role) => [role, color(role)])),
    unwanted: color("unwanted"),
    other: color("other"),
    itch: color("itch"),
    tip: color("tip"),
    ghost: color("ghost"),
    grid: color("grid"),
    shadow: dark ? 0.4 : 0.14,
    sky: dark ? 1.5 : 2.1,
  };
}

/** A geom's colour: that of its role, tinted by the colour the scene gives it. */
export function colorOf(geom: Geom, look: Look): Color {
  const own = new Color().setRGB(geom.rgba[0], geom.rgba[1], geom.rgba[2], "srgb");
  const role = look.roles[geom.role];
  return role ? role.clone().lerp(own, OWN_SHARE) : own;
}
