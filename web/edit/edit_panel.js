// The Edit tab put together.

import { RobotChoice } from "../model/robot_choice.js";
import { watchDefaultsForm } from "./defaults_form.js";
import { watchHistoryButtons } from "./history_buttons.js";
import { MapForm } from "./map_form.js";
import { watchNewMapForm } from "./new_map_form.js";
import { RobotActions } from "./robot_actions.js";
import { RobotForm } from "./robot_form.js";
import { watchRobotPicker } from "./robot_picker.js";
import { Toolbox } from "./toolbox.js";

export class EditPanel {
  #toolbox;

  /** Which robot is edited, see RobotChoice. */
  choice;

  /** `opening`: see Opening. */
  constructor(session, stage, tabs, opening) {
    this.choice = new RobotChoice(session);
    const actions = new RobotActions(session, this.choice);
    this.#toolbox = new Toolbox(session, stage, tabs, this.choice, actions);
    watchHistoryButtons(session);
    watchRobotPicker(session, this.choice);
    new RobotForm(session, this.choice, actions);
    watchDefaultsForm(session);
    new MapForm(session);
    watchNewMapForm(session, async (request) => {
      if (await opening.text("new map", JSON.stringify(request))) this.take("wall");
    });
  }

  /** Takes a tool in hand: select, wall, erase, box or robot. */
  take(tool) {
    this.#toolbox.take(tool);
  }
}
