// The menu over the scene that says how things are shown.

import { STATES_IN_WORDS } from "../scene/palette.js";
import { byId, element } from "../ui/dom.js";
import { makeClosable } from "../ui/menu.js";

/** Applies what is chosen in the menu to the stage. */
export function watchViewMenu(stage) {
  const menu = byId("view-menu");
  for (const choice of menu.querySelectorAll("input[type=radio]")) {
    choice.addEventListener("change", () => stage.setLook({ [choice.name]: choice.value }));
  }
  byId("state-legend").replaceChildren(
    ...Object.entries(STATES_IN_WORDS).map(([state, words]) => {
      return element("li", {}, element("span", { class: `swatch filled state-${state}` }), words);
    }),
  );
  makeClosable(menu);
}
