/** The button that plays and pauses, wherever motions are shown. */
import { button, s } from "../base/dom.js";

const PLAY = "M3 1.5v13l11-6.5z";
const PAUSE = "M3 1.5h3.6v13H3zM9.4 1.5H13v13H9.4z";

export interface PlayButton {
  readonly element: HTMLButtonElement;
  /** Shows what a press would do now. */
  refresh(playing: boolean): void;
}

/** `names`: what it is called to a screen reader while it would play, and while it would pause. */
export function playButton(toggle: () => void, names: { readonly play: string; readonly pause: string }): PlayButton {
  const icon = s("path", {});
  const element = button(s("svg", { viewBox: "0 0 16 16", width: 16, height: 16, "aria-hidden": "true" }, icon), toggle, { class: "play" });
  const refresh = (playing: boolean): void => {
    icon.setAttribute("d", playing ? PAUSE : PLAY);
    element.setAttribute("aria-label", playing ? names.pause : names.play);
  };
  refresh(false);
  return { element, refresh };
}
