// What lies over the scene: the view menu, and the line about the robot under the pointer.

import { STATES_IN_WORDS } from "../scene/palette.js";
import { byId, element, makeClosable, setText } from "../ui/dom.js";
import { degrees } from "../ui/format.js";
import { NO_PREFERENCES } from "../ui/preferences.js";

/** Applies what is chosen in the menu to the stage, and what was chosen before. `preferences`: see Preferences. */
export function watchViewMenu(stage, preferences = NO_PREFERENCES) {
  const menu = byId("view-menu");
  const lattice = menu.querySelector("input[name=lattice]");
  const choices = [...menu.querySelectorAll("input[type=radio]")];
  const look = preferences.get("look", {});
  for (const choice of choices) if (look[choice.name] === choice.value) choice.checked = true;
  lattice.checked = look.lattice === true;
  const apply = () => {
    const chosen = choices.filter(({ checked }) => checked).map(({ name, value }) => [name, value]);
    const shown = { ...Object.fromEntries(chosen), lattice: lattice.checked };
    stage.setLook(shown);
    return shown;
  };
  apply();
  for (const choice of [...choices, lattice]) {
    choice.addEventListener("change", () => preferences.set("look", apply()));
  }
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
