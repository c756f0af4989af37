/** Sends something once: its controls rest meanwhile, and a refusal is said in place. */
import { h } from "../../base/dom.js";
import { Refused, type Words } from "../context.js";

/** Runs `act` with the controls of `part` disabled; shows below them what the server refused. */
export async function sending(
  part: HTMLElement, words: Words, announce: (message: string) => void, act: () => Promise<void>,
): Promise<void> {
  const controls = [...part.querySelectorAll<HTMLButtonElement | HTMLInputElement>("button, input, select")]
    .filter((control) => !control.disabled);
  part.querySelector(".refused")?.remove();
  for (const control of controls) control.disabled = true;
  try {
    await act();
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
    const message = words("shell.refused", { message: error.message });
    part.append(h("p", { class: "problem refused" }, message));
    announce(message);
  } finally {
    for (const control of controls) control.disabled = false;
  }
}
