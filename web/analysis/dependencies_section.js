// The dependencies of a plan: for the action under way of the selected robot, in words and as arrows.

import { dependenciesOfAction, momentOf } from "../model/dependencies.js";
import { actionInWords } from "../model/itinerary.js";
import { actionIndexAt } from "../model/timeline.js";
import { robotChip } from "../panels/robot_list.js";
import { paintSceneArrows, paintTimelineArrows } from "../scene/dependency_arrows.js";
import { element, setText } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";
import { percent } from "../model/simulation.js";
import { button } from "./fields.js";

const MAX_TIGHT = 6;

export class DependenciesSection {
  #page;
  #session;
  #show = button("Show dependencies", () => this.#ask());
  #status = element("p", { class: "facts", role: "status" });
  #list = element("div", { class: "results" });
  /** @type {any} */
  #found = null; // {answer, dependencies, tight}
  #shown = /** @type {any} */ ({}); // {robot, action, found}
  /** @type {any[]} */
  #arrows = [];

  element;

  /** `page`: see fillAnalysis. */
  constructor(page) {
    this.#page = page;
    this.#session = page.session;
    this.element = element("div", { class: "simulation" }, this.#show, this.#status, this.#list);
    page.stage.addOverlay((context, view) => paintSceneArrows(context, view, this.#arrows));
    page.timeline.addOverlay((context, theme, chart) =>
      paintTimelineArrows(context, theme, chart, this.#arrows),
    );
    this.#session.on("answer", () => this.#reset());
    this.#session.on("marks time", () => this.#update());
    this.#reset();
  }

  #reset() {
    this.#found = null;
    this.#show.hidden = false;
    this.#show.disabled = !this.#session.hasPlan;
    setText(this.#status, "Which robot passes first, so that the plan can be executed at any pace.");
    this.#update();
  }

  async #ask() {
    const { answer, request } = this.#session;
    this.#show.disabled = true;
    try {
      const { dependencies, tight } = await this.#page.service.dependencies(request, answer);
      if (answer !== this.#session.answer) return;
      this.#found = { dependencies: dependencies ?? [], tight: tight ?? [] };
      this.#show.hidden = true;
      this.#update();
    } catch (error) {
      this.#show.disabled = false;
      this.#session.fail(error);
    }
  }

  #update() {
    const shown = { ...this.#current(), found: this.#found };
    if (Object.entries(shown).every(([name, value]) => this.#shown[name] === value)) return;
    this.#shown = shown;
    this.#arrows = [];
    this.#list.replaceChildren();
    if (this.#found !== null) this.#describe(shown);
    this.#page.stage.redraw();
    this.#page.timeline.redraw();
  }

  /** The selected robot and the number of its action under way; -1 if there is none. */
  #current() {
    const { selected, tracks, player } = this.#session;
    const actions = tracks.get(selected)?.actions ?? [];
    const isUnderWay = actions.length > 0 && player.time < actions.at(-1).t_end;
    return { robot: selected, action: isUnderWay ? actionIndexAt(actions, player.time) : -1 };
  }

  #describe({ robot, action }) {
    const { dependencies, tight } = this.#found;
    setText(this.#status, `${count(dependencies.length, "dependency", "dependencies")} in the plan.`);
    this.#list.append(this.#tight(tight));
    if (action < 0) {
      this.#list.prepend(element("p", { textContent: "Select a moving robot." }));
      return;
    }
    const { waitsFor, heldFor } = dependenciesOfAction(dependencies, robot, action);
    this.#arrows = [...this.#arrowsOf("waitsFor", waitsFor), ...this.#arrowsOf("heldFor", heldFor)];
    const words = actionInWords(this.#session.tracks.get(robot).actions[action]);
    this.#list.prepend(
      element("h2", { textContent: `${robot}, action ${action}: ${words}` }),
      this.#sentences(waitsFor, "until", ({ gate }) => [
        `May pass ${percent(gate.progress)} after`,
        "has completed",
      ]),
      this.#sentences(heldFor, "gate", ({ until }) => [`At ${percent(until.progress)}, allows`, "to pass"]),
      waitsFor.length + heldFor.length === 0
        ? element("p", { textContent: "This action has no dependencies." })
        : "",
    );
  }

  /** A sentence for each, about the robot of its `other` end; `words` returns what is before and after the name. */
  #sentences(found, other, words) {
    const items = found.map((each) => {
      const { robot, action, progress } = each[other];
      const at = momentOf(this.#session.tracks.get(robot)?.actions ?? [], each[other]);
      const [before, after] = words(each);
      const what = `${after} ${percent(progress)} of its action ${action}`;
      const when = at === null ? "" : ` (${seconds(at.t)})`;
      return element("li", { class: "chips" }, before, robotChip(this.#session, robot), what + when);
    });
    return element("ul", { class: "plain" }, ...items);
  }

  #tight(tight) {
    if (tight.length === 0) return "";
    const items = tight.slice(0, MAX_TIGHT).map(({ robots, t, slack }) => {
      const show = button(`${seconds(t)}, slack ${seconds(slack)}`, () => this.#session.seek(t), {
        class: "quiet",
      });
      return element("li", { class: "chips" }, ...robots.map((id) => robotChip(this.#session, id)), show);
    });
    const title = `${count(tight.length, "pair")} too close in time to tolerate any delay`;
    return element(
      "div",
      {},
      element("h2", { textContent: title }),
      element("ul", { class: "plain" }, ...items),
    );
  }

  #arrowsOf(kind, found) {
    const ends = found.map(({ gate, until }) => ({ kind, from: this.#end(until), to: this.#end(gate) }));
    return ends.filter(({ from, to }) => from !== null && to !== null);
  }

  #end(place) {
    const moment = momentOf(this.#session.tracks.get(place.robot)?.actions ?? [], place);
    return moment && { ...moment, robot: place.robot };
  }
}
