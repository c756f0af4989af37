/** The screen of practise and play: a 3D view of the task, once scene and devices are known. */
import { h } from "../../base/dom.js";
import type { Mount } from "../context.js";
import { waysHere } from "./devices.js";
import { LiveView } from "./live-view.js";
import { Session } from "./session.js";

export const mountPlay: Mount = (root, context) => {
  const canvas = h("canvas", { tabindex: 0, role: "application", "aria-label": context.words("play.picture") });
  const theatre = h("div", { class: "theatre" }, canvas);
  root.append(theatre);
  let session: Session | null = null;
  let gone = false;
  let newest = context.state;
  void Promise.all([context.api.scene(), waysHere()]).then(([scene, ways]) => {
    if (gone) return;
    const live = scene && LiveView.create(canvas, scene);
    if (!live) {
      root.replaceChildren(h("div", { class: "card" }, h("h1", {}, context.words("shell.no-webgl"))));
      return;
    }
    session = new Session(context, theatre, live, ways);
    session.update(newest);
  });
  return {
    update: (state) => {
      newest = state;
      session?.update(state);
    },
    pause: () => session?.pause(),
    resume: () => session?.resume(),
    dispose: () => {
      gone = true;
      session?.dispose();
    },
  };
};
