// The form of the moving obstacles: the list to choose one from, its disk, and where it is when.

import {
  addObstacle,
  appendEntry,
  deleteObstacle,
  motionOf,
  removeEntry,
  setEntry,
  setObstacle,
} from "../model/edit_obstacles.js";
import { obstaclesOf } from "../model/listed.js";
import { snapPoint } from "../model/placement.js";
import { chosenIn, showChoices } from "../ui/choices.js";
import { byId, element, setCount } from "../ui/dom.js";
import { NumberField } from "../ui/number_field.js";

const USUAL_RADIUS = 0.3; // metres: a person
const ENTRY = { t: ["At", "s"], x: ["x", "m"], y: ["y", "m"] };

export class ObstacleForm {
  #session;
  #stage;
  #list = byId("edited-obstacle");
  #form = byId("obstacle-form");
  #id = byId("obstacle-id");
  #stays = byId("obstacle-stays");
  #entries = byId("obstacle-motion");
  #radius;
  #rows = /** @type {any[]} */ ([]); // {element, fields}
  /** @type {number | null} */
  #index = null;

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
    const settle = () => session.endGesture();
    this.#radius = new NumberField({
      label: "Radius",
      unit: "m",
      required: true,
      accept: (radius) => this.#set({ radius }, "radius"),
      settle,
    });
    byId("obstacle-numbers").append(this.#radius.element);
    this.#list.addEventListener("change", () => {
      this.#index = chosenIn(this.#list);
      this.#refresh();
    });
    this.#id.addEventListener("input", () => this.#set({ id: this.#id.value }, "id"));
    this.#id.addEventListener("change", settle);
    this.#stays.addEventListener("change", () =>
      this.#set({ after: this.#stays.checked ? "stays" : undefined }, "after"),
    );
    byId("add-obstacle").addEventListener("click", () => this.#add());
    byId("append-entry").addEventListener("click", () => this.#edit(appendEntry));
    byId("delete-obstacle").addEventListener("click", () => {
      this.#edit(deleteObstacle);
      byId("add-obstacle").focus();
    });
    session.on("request", ({ opened }) => {
      if (opened) this.#index = null;
      this.#refresh();
    });
    this.#refresh();
  }

  #edit(change, gesture = /** @type {any} */ (null)) {
    this.#session.edit(change(this.#session.request, this.#index), gesture);
  }

  #set(members, name) {
    this.#edit((request, index) => setObstacle(request, index, members), `obstacle ${this.#index} ${name}`);
  }

  /** Adds one in the middle of the view. */
  #add() {
    const { request, scene } = this.#session;
    const place = snapPoint(scene.grid, this.#stage.middle, false);
    this.#index = obstaclesOf(request).length;
    this.#session.edit(addObstacle(request, place, scene.robots.at(-1)?.radius ?? USUAL_RADIUS));
    this.#session.announce(`${this.#id.value} added in the middle of the view.`);
  }

  #refresh() {
    const obstacles = obstaclesOf(this.#session.request);
    if ((this.#index ?? 0) >= obstacles.length) this.#index = null;
    this.#showList(obstacles);
    const index = this.#index;
    this.#form.hidden = index === null;
    if (index === null) return;
    const obstacle = obstacles[index] ?? {};
    const pointer = `/obstacles/${index}`;
    this.#form.dataset.pointer = pointer;
    this.#id.dataset.pointer = `${pointer}/id`;
    this.#radius.input.dataset.pointer = `${pointer}/radius`;
    if (this.#id.value !== obstacle.id) this.#id.value = obstacle.id ?? "";
    this.#radius.show(obstacle.radius);
    this.#stays.checked = obstacle.after === "stays";
    this.#showMotion(motionOf(obstacle), `${pointer}/motion`);
  }

  #showList(obstacles) {
    const names = obstacles.map((obstacle, at) => obstacle?.id || `#${at}`);
    const none = names.length > 0 ? "None selected" : "No moving obstacles";
    showChoices(this.#list, names, none, this.#index);
  }

  #showMotion(motion, pointer) {
    setCount(this.#entries, this.#rows, motion.length, (number) => this.#row(number));
    motion.forEach((entry, number) => {
      for (const [name, field] of Object.entries(this.#rows[number].fields)) {
        field.input.dataset.pointer = `${pointer}/${number}/${name}`;
        field.show(entry?.[name]);
      }
    });
  }

  #row(number) {
    const fields = Object.fromEntries(
      Object.entries(ENTRY).map(([name, [label, unit]]) => {
        const gesture = () => `obstacle ${this.#index} ${number} ${name}`;
        const accept = (value) =>
          this.#edit((request, index) => setEntry(request, index, number, { [name]: value }), gesture());
        const settle = () => this.#session.endGesture();
        return [name, new NumberField({ label, unit, required: true, accept, settle })];
      }),
    );
    const remove = element("button", { type: "button", class: "quiet", textContent: "Remove" });
    remove.setAttribute("aria-label", `Remove: waypoint ${number + 1}`);
    remove.addEventListener("click", () => {
      this.#edit((request, index) => removeEntry(request, index, number));
      if (!remove.isConnected) byId("append-entry").focus(); // the focus would be lost
    });
    const parts = Object.values(fields).map((field) => field.element);
    const row = element("li", { class: "field" }, element("div", { class: "parts" }, ...parts), remove);
    return { element: row, fields };
  }
}
