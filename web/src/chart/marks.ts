/**
 * Marks that can be pointed at, tabbed to and chosen. One tab stop per chart; arrow keys walk
 * from mark to mark, Enter or Space chooses. Where marks cover each other, clicking again chooses
 * the next of those below the pointer.
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
  /** Told of the mark that is pointed at, and how many others lie below the pointer. */
  readonly peek: (mark: Mark, others: number) => void;
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
    const point = (event: PointerEvent): void => actions.peek(mark, Math.max(0, below(marks, event).length - 1));
    mark.element.setAttribute("role", "button");
    on(mark.element, {
      click: (event) => actions.choose(next(below(marks, event), mark).id),
      pointerenter: point,
      pointermove: point,
      pointerleave: actions.leave,
      focus: () => actions.peek(mark, 0),
      blur: actions.leave,
      keydown: (event) => {
        if (event.key === "Enter" || event.key === " ") actions.choose(mark.id);
        else if (KEYS.has(event.key)) {
          const there = neighbour(positions, index, event.key as Arrow);
          setStop(there);
          marks[there]?.element.focus();
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

/**
 * Makes `cover`, which is no choice itself, hand clicks on to the marks below it.
 *
 * @param peek Told how many marks lie below the pointer.
 */
export function seeThrough(
  cover: SVGElement,
  marks: readonly Mark[],
  { choose, peek, leave }: Pick<Actions, "choose" | "leave"> & { readonly peek: (covered: number) => void },
): void {
  const point = (event: PointerEvent): void => {
    const covered = below(marks, event).length;
    cover.classList.toggle("covers", covered > 0);
    peek(covered);
  };
  on(cover, {
    click: (event) => {
      const here = below(marks, event);
      const top = here.at(-1);
      if (top) choose(next(here, top).id);
    },
    pointerenter: point,
    pointermove: point,
    pointerleave: leave,
  });
}

function below(marks: readonly Mark[], { clientX, clientY }: MouseEvent): Mark[] {
  const hit = document.elementsFromPoint(clientX, clientY);
  return marks.filter(({ element }) => hit.some((part) => element.contains(part)));
}

/** The mark after the chosen one, round and round, if that lies here; else the one that was hit. */
function next(here: readonly Mark[], hit: Mark): Mark {
  const chosen = here.findIndex(({ element }) => element.getAttribute("aria-pressed") === "true");
  return chosen < 0 ? hit : here[(chosen + 1) % here.length] ?? hit;
}
