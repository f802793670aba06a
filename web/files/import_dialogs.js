// The dialogs about files that leave a choice; one at a time.

import { RosMapDialog } from "./ros_dialog.js";
import { ScenarioDialog } from "./scenario_dialog.js";

export class ImportDialogs {
  #session;
  #shown = null;

  constructor(session) {
    this.#session = session;
  }

  /** Resolves to a request with robots of a scenario, or to null if that is given up. */
  scenario(name, map, entries, defaults) {
    const most = this.#session.limits.max_robots ?? Infinity;
    return this.#ask(new ScenarioDialog(name, map, entries, defaults, most));
  }

  /** Resolves to the map of a request, or to null if that is given up. */
  rosMap(name, grid, warnings) {
    const most = this.#session.limits.max_cells ?? Infinity;
    return this.#ask(new RosMapDialog(name, grid, warnings, most));
  }

  /** Gives up whatever is asked. */
  dismiss() {
    this.#shown?.giveUp();
  }

  async #ask(dialog) {
    this.#shown = dialog;
    try {
      return await dialog.ask();
    } finally {
      if (this.#shown === dialog) this.#shown = null;
    }
  }
}
