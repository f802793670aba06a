// What lies over the scene: the view menu, and the line about the robot under the pointer.

import { STATES_IN_WORDS } from "../scene/palette.js";
import { byId, element, makeClosable, setText } from "../ui/dom.js";
import { degrees } from "../ui/format.js";

/** Applies what is chosen in the menu to the stage. */
export function watchViewMenu(stage) {
  const menu = byId("view-menu");
  for (const choice of menu.querySelectorAll("input[type=radio]")) {
    choice.addEventListener("change", () => stage.setLook({ [choice.name]: choice.value }));
  }
  const lattice = menu.querySelector("input[name=lattice]");
  lattice.addEventListener("change", () => stage.setLook({ lattice: lattice.checked }));
  byId("state-legend").replaceChildren(
    ...Object.entries(STATES_IN_WORDS).map(([state, words]) => {
      return element("li", {}, element("span", { class: `swatch filled state-${state}` }), words);
    }),
  );
  makeClosable(menu);
}

export function watchReadout(session) {
  const readout = byId("readout");
  session.on("answer marks time", () => {
    const id = session.hovered ?? session.selected;
    const pose = id === null ? null : session.poseOf(id);
    readout.hidden = pose === null;
    if (pose === null) return;
    const where = `(${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}) m, ${degrees(pose.theta)}`;
    setText(readout, `${id}: ${session.stateOf(id)} at ${where}`);
  });
}
