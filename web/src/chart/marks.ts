/**
 * Marks that can be pointed at, tabbed to and chosen. One tab stop per chart; arrow keys walk
 * from mark to mark, Enter or Space chooses.
 */
import { on } from "../base/dom.js";
import { neighbour, type Arrow, type XY } from "./hull.js";

export interface Mark {
  readonly id: string;
  readonly element: SVGElement;
  /** Where it stands in its chart [px]; tooltips and arrow keys go by this. */
  readonly at: XY;
}

export interface Actions {
  readonly choose: (id: string) => void;
  readonly peek: (mark: Mark) => void;
  readonly leave: () => void;
}

const KEYS = new Set(["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End"]);

/** Makes marks interactive; the returned function moves the choice and the tab stop to `id`. */
export function interactive(marks: readonly Mark[], actions: Actions): (id: string | null) => void {
  // Keys go by screen position, but up must mean more: y grows downwards on screen.
  const positions = marks.map(({ at: [x, y] }): XY => [x, -y]);
  const setStop = (index: number): void => {
    marks.forEach(({ element }, i) => element.setAttribute("tabindex", i === index ? "0" : "-1"));
  };
  marks.forEach((mark, index) => {
    mark.element.setAttribute("role", "button");
    on(mark.element, {
      click: () => actions.choose(mark.id),
      pointerenter: () => actions.peek(mark),
      pointerleave: actions.leave,
      focus: () => actions.peek(mark),
      blur: actions.leave,
      keydown: (event) => {
        if (event.key === "Enter" || event.key === " ") actions.choose(mark.id);
        else if (KEYS.has(event.key)) {
          const next = neighbour(positions, index, event.key as Arrow);
          setStop(next);
          marks[next]?.element.focus();
        } else if (event.key === "Escape") actions.leave();
        else return;
        event.preventDefault();
      },
    });
  });
  setStop(0);
  return (id) => {
    marks.forEach(({ id: own, element }) => {
      element.setAttribute("aria-pressed", String(own === id));
      element.classList.toggle("chosen", own === id);
    });
    setStop(Math.max(0, marks.findIndex((mark) => mark.id === id)));
  };
}
