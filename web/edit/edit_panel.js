// The Edit tab: its tools, its forms, undo and redo.

import { RobotChoice } from "../model/selection.js";
import { byId, element, icon, setText } from "../ui/dom.js";
import { CommittedForm } from "./committed_form.js";
import { BoxTool, DrawTool } from "./draw_tools.js";
import { GoalsForm } from "./goals_form.js";
import { GroupForm } from "./group_form.js";
import { MapForm, watchNewMapForm } from "./map_form.js";
import { ObstacleForm } from "./obstacle_form.js";
import { PlacingPanel } from "./placing_panel.js";
import { RobotActions } from "./robot_actions.js";
import { RobotForm, watchDefaultsForm, watchRobotPicker } from "./robot_form.js";
import { RobotTool } from "./robot_tool.js";
import { SelectTool } from "./select_tool.js";
import { ZoneChoice } from "./zone_choice.js";
import { ZoneForm } from "./zone_form.js";
import { ZoneTool } from "./zone_tool.js";

const TAB = "tab-edit";

export class EditPanel {
  #toolbox;

  /** Which robot is edited, see RobotChoice. */
  choice;

  /** `opening`: see Opening; `inShort`: see PlacingPanel. */
  constructor(session, stage, tabs, opening, inShort) {
    this.choice = new RobotChoice(session);
    const actions = new RobotActions(session, this.choice);
    const zones = new ZoneChoice(session);
    const zoneTool = new ZoneTool(session, stage, zones);
    this.#toolbox = new Toolbox(session, stage, tabs, this.choice, actions, zoneTool, inShort);
    new ZoneForm(session, zones);
    new ObstacleForm(session, stage);
    zones.onChange(() => zones.index !== null && (byId("zones").open = true));
    watchHistoryButtons(session);
    watchRobotPicker(session, this.choice);
    new RobotForm(session, this.choice, actions);
    new GroupForm(session);
    new GoalsForm(session, this.choice);
    new CommittedForm(session, this.choice);
    watchDefaultsForm(session);
    new MapForm(session);
    watchNewMapForm(session, async (request) => {
      if (await opening.text("new map", JSON.stringify(request))) this.pick("wall");
    });
  }

  /** Selects a tool: select, wall, erase, box, robot or zone. */
  pick(tool) {
    this.#toolbox.pick(tool);
  }
}

const ICONS = {
  select: "M5 3.5 15.5 9.6 10.8 11l-2.2 4.6z",
  wall: "M3 5h14v10H3zM3 10h14M10 5v5M6.5 10v5M13.5 10v5",
  erase: "M8 16l-4.5-4.5L11 4l5.5 5.5L10 16zM7.3 7.7l5.5 5.5M8 16h8.5",
  box: "M3.5 5.5h13v9h-13zM7.5 5.5l-4 4M12 5.5l-8.5 8.5M16.5 5.5l-9 9M16.5 10l-4.5 4.5",
  zone: "M4 6.5 12.5 3.5 16.5 10 11 16.5 4 14z",
  robot: "M14.5 11.5a5.5 5.5 0 1 1-6-6M9 11l3-3M14.5 2.5v6M11.5 5.5h6",
};

export class Toolbox {
  #tools;
  #stage;
  #tabs;
  #radios = new Map(); // name -> input
  #chosen = "select";
  #placing;

  /** `choice`: see RobotChoice; `actions`: see RobotActions. */
  constructor(session, stage, tabs, choice, actions, zoneTool, inShort) {
    this.#stage = stage;
    this.#tabs = tabs;
    const robotTool = new RobotTool(session, stage, choice, actions);
    this.#placing = new PlacingPanel(session, robotTool, (name) => this.pick(name), inShort);
    this.#tools = {
      select: { label: "Select", key: "V", tool: new SelectTool(session, stage, choice, actions) },
      wall: { label: "Wall", key: "W", tool: new DrawTool(session, stage, true) },
      erase: { label: "Erase", key: "E", tool: new DrawTool(session, stage, false) },
      box: { label: "Box", key: "B", tool: new BoxTool(session, stage) },
      robot: { label: "Robot", key: "A", tool: robotTool },
      zone: { label: "Zone", key: "Z", tool: zoneTool },
    };
    byId("tools").replaceChildren(...Object.keys(this.#tools).map((name) => this.#button(name)));
    tabs.onChange(() => this.#refresh());
    session.on("planning", () => session.planning !== null && this.#choose("select"));
    session.on("request", ({ opened }) => opened && this.#choose("select"));
    this.#refresh();
  }

  /** Selects a tool on the Edit tab and focuses the scene for the keyboard. */
  pick(name) {
    this.#tabs.choose(TAB);
    this.#choose(name);
    this.#stage.canvas.focus();
  }

  #button(name) {
    const { label, key } = this.#tools[name];
    const id = `tool-${name}`;
    const radio = element("input", {
      type: "radio",
      name: "tool",
      id,
      value: name,
      class: "visually-hidden",
    });
    radio.addEventListener("change", () => this.#choose(name));
    this.#radios.set(name, radio);
    const face = element("label", { htmlFor: id, title: `${label} (${key})` }, icon(ICONS[name]), label);
    return element("div", { class: "tool" }, radio, face);
  }

  #choose(name) {
    this.#chosen = name;
    this.#refresh();
  }

  #refresh() {
    const { tool } = this.#tools[this.#chosen];
    this.#radios.get(this.#chosen).checked = true;
    setText(byId("tool-help"), tool.help);
    setText(byId("tool-keys"), tool.keys);
    const editing = this.#tabs.chosen === TAB;
    document.documentElement.classList.toggle("editing", editing);
    this.#stage.setTool(editing ? tool : null);
    this.#placing.show(editing ? tool : null);
  }
}

export function watchHistoryButtons(session) {
  const undo = byId("undo");
  const redo = byId("redo");
  undo.addEventListener("click", () => session.undo());
  redo.addEventListener("click", () => session.redo());
  session.on("request", () => {
    const focused = document.activeElement;
    undo.disabled = !session.canUndo;
    redo.disabled = !session.canRedo;
    if (focused === undo && undo.disabled) redo.focus(); // the focus would be lost
    if (focused === redo && redo.disabled) undo.focus();
  });
}
