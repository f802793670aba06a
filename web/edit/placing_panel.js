// The line below the scene that leads from a map to a plan. It says what the next click does, the radius of robots, and
// whether they fit.

import { numbersOfNext, setDefault } from "../model/edit_request.js";
import { misplaced } from "../model/placement.js";
import { byId, setText } from "../ui/dom.js";
import { count } from "../ui/format.js";
import { NumberField } from "../ui/number_field.js";

export class PlacingPanel {
  #session;
  #box = byId("placing");
  #place = byId("placing-robots");
  #plan = byId("placing-plan");
  #radius;
  /** @type {any} */
  #tool = null; // the tool of the Edit tab, null on another tab
  #robotTool;
  #inShort;
  #isAsked = false; // the plan, by this panel
  #refusal = ""; // why the last click placed nothing
  #checked = /** @type {any} */ ({ scene: null, wrong: [] }); // see misplaced

  /** `robotTool`: see RobotTool; `pick(name)` selects a tool; `inShort(answer, options)` is a plan in words. */
  constructor(session, robotTool, pick, inShort) {
    this.#session = session;
    this.#inShort = inShort;
    this.#robotTool = robotTool;
    this.#radius = new NumberField({
      label: "Radius",
      unit: "m",
      accept: (value) => session.edit(setDefault(session.request, "radius", value), "default radius"),
      settle: () => session.endGesture(),
    });
    byId("placing-radius").append(this.#radius.element);
    this.#place.addEventListener("click", () => pick("robot"));
    this.#plan.addEventListener("click", () => {
      this.#isAsked = true;
      byId("plan").click();
    });
    session.on("request", () => (this.#isAsked = false));
    session.on("answer", () => this.#refresh());
    session.on("request marks planning", () => this.#refresh());
    robotTool.onRefusal((text) => {
      this.#refusal = text;
      this.#refresh();
    });
  }

  /** Shows what is of use with a tool; null: nothing. */
  show(tool) {
    this.#tool = tool;
    this.#refresh();
  }

  #refresh() {
    const { scene, request, planning } = this.#session;
    const { robots, grid } = scene;
    const places = this.#tool === this.#robotTool;
    const { answer, hasPlan } = this.#session;
    const hasResult = this.#isAsked && hasPlan && planning === null && !places;
    const isIdle = this.#tool === null || grid === null || (!places && robots.length > 0);
    this.#box.hidden = isIdle && !hasResult;
    if (this.#box.hidden) return;
    byId("placing-result").hidden = !hasResult;
    setText(byId("placing-result"), hasResult ? this.#inShort(answer, request.options) : "");
    byId("placing-text").hidden = hasResult;
    this.#place.hidden = places;
    byId("placing-radius").hidden = this.#plan.hidden = !places;
    this.#plan.disabled = planning !== null || robots.length === 0;
    setText(byId("placing-text"), places ? this.#nextClick(robots) : (this.#tool?.help ?? ""));
    const wrong = places ? this.#misplacedIn(scene) : [];
    const fit = places && robots.length > 0 ? inWords(robots, wrong) : "";
    const refusal = places ? this.#refusal : "";
    setText(byId("placing-fit"), refusal || fit);
    byId("placing-fit").classList.toggle("wrong", refusal !== "" || wrong.length > 0);
    this.#radius.show(request?.robot_defaults?.radius, {
      placeholder: String(numbersOfNext(request).radius),
    });
  }

  #misplacedIn(scene) {
    if (this.#checked.scene !== scene) this.#checked = { scene, wrong: misplaced(scene) };
    return this.#checked.wrong;
  }

  #nextClick(robots) {
    const { awaiting } = this.#robotTool;
    if (awaiting !== null) return `Click where ${awaiting.id} goes.`;
    return `Click where ${robots.length === 0 ? "a" : "the next"} robot starts.`;
  }
}

/** Whether robots fit, in words. `wrong`: the robots that do not fit, see misplaced. */
function inWords(robots, wrong) {
  if (wrong.length === 0)
    return `${count(robots.length, "robot")}: ${robots.length === 1 ? "fits" : "all fit"}.`;
  const [{ robot, pose }] = wrong;
  const more = wrong.length === 1 ? "" : ` and ${count(wrong.length - 1, "other")}`;
  return `${robot.id}${more} ${wrong.length === 1 ? "does" : "do"} not fit: too near to a wall or another robot at its ${pose}.`;
}
