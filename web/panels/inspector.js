// The card of the selected robot: its cost, how it spends its time, its actions, with the cause of each wait, and its
// speeds.

import { delayOf } from "../model/gantt.js";
import { actionInWords, totals, causeOfWait } from "../model/itinerary.js";
import { blockersOf } from "../model/stuck.js";
import { actionIndexAt } from "../model/timeline.js";
import { byId, element, icon, scrollWithin, setText } from "../ui/dom.js";
import { seconds } from "../ui/format.js";
import { blockedBy, robotChip } from "./robot_list.js";
import { SpeedChart } from "./speed_chart.js";
import { REASONS } from "./unplanned_card.js";

const EDITING = "tab-edit"; // whose form shows the robot instead
const CROSS = "M5 5 15 15M15 5 5 15";
const MARGIN = { top: 60, side: 12, bottom: 12 }; // pixels around the card: above are the view's buttons
const COLUMNS = ["From, s", "To, s", "Action"];
const NO_ACTIONS = {
  parked: "It has no goal and stays at its start.",
  idle: "It has nothing to do, and is in nobody's way.",
  planned: "It is already at its goal.",
  outdated: "An edit made its plan invalid. Plan again.",
  ready: "It is not part of the plan and stays at its start.",
};

const STUCK = "It comes no nearer to its goals within the planning horizon.";

const CORNERS = ["top-right", "bottom-right", "bottom-left"]; // in order of preference

export class Inspector {
  #session;
  #stage;
  #colours;
  #fleet;
  #tabs;
  #box = byId("inspector");
  #shown = null; // the id of the robot shown
  #ofGroup = false; // whether it was one of several that were chosen
  #state = null; // the element with its current state
  /** @type {SpeedChart | null} */
  #speeds = null;
  #rows = []; // of the table, one an action
  #current = -1; // the row of the action under way

  /** `colours`: see RobotColours; `fleet`: see FleetMotion; `tabs`: the page's. */
  constructor(session, stage, colours, fleet, tabs) {
    this.#session = session;
    this.#stage = stage;
    this.#colours = colours;
    this.#fleet = fleet;
    this.#tabs = tabs;
    session.on("answer", () => this.#show());
    session.on("marks", () => this.#isOther && this.#show());
    session.on("time", () => this.#update());
    colours.onChange(() => this.#show());
    tabs.onChange(() => this.#show());
  }

  get #isOther() {
    return this.#session.selected !== this.#shown || this.#isGroup !== this.#ofGroup;
  }

  /** Whether more robots than a pair are chosen: their figures stand side by side instead. */
  get #isGroup() {
    return this.#session.chosen.length > 2;
  }

  #show() {
    const { selected, answer } = this.#session;
    const before = this.#shown;
    const hadFocus = this.#box.contains(document.activeElement);
    this.#shown = selected;
    this.#ofGroup = this.#isGroup;
    this.#speeds = null;
    this.#rows = [];
    this.#current = -1;
    this.#box.hidden = selected === null || answer === null || this.#isGroup || this.#tabs.chosen === EDITING;
    if (this.#box.hidden) {
      if (hadFocus) rowOf(before)?.focus();
      this.#box.replaceChildren();
      return;
    }
    const robot = this.#session.robot(selected);
    const track = this.#session.tracks.get(selected);
    this.#box.setAttribute("aria-label", `Robot ${selected}`);
    this.#box.replaceChildren(this.#head(robot, track), ...this.#body(robot, track));
    this.#update();
    this.#box.dataset.corner = cornerFor(
      { width: this.#box.offsetWidth, height: this.#box.offsetHeight },
      { width: this.#stage.canvas.clientWidth, height: this.#stage.canvas.clientHeight },
      MARGIN,
      this.#placesOf(robot, track).map((place) => this.#stage.screenOf(place, 0)),
    );
    this.#bringIntoSight();
  }

  /** Where the card is below the scene, as on phones, and the scene is seen: scrolls to it. */
  #bringIntoSight() {
    const { top, bottom } = this.#stage.canvas.getBoundingClientRect();
    const isBelow = this.#box.getBoundingClientRect().top >= bottom - 1;
    const middle = (top + bottom) / 2;
    if (isBelow && middle > 0 && middle < innerHeight) this.#box.scrollIntoView({ block: "nearest" });
  }

  /** What the card should not hide: the robot, its path and goal, and its blockers. */
  #placesOf(robot, track) {
    const goal = robot.goal === null ? [] : [robot.goal];
    const now = [robot.id, ...blockersOf(track)]
      .map((id) => this.#session.poseOf(id))
      .filter((pose) => pose !== null);
    return [...now, ...goal, ...track.path];
  }

  #head(robot, track) {
    const swatch = element("span", { class: `swatch${track.status === "unplanned" ? "" : " filled"}` });
    swatch.style.color = this.#colours.of(robot.index);
    this.#state = element("span", { class: `robot-state ${track.status}` });
    const close = element(
      "button",
      { type: "button", class: "icon close", title: "Close (Esc)" },
      icon(CROSS),
    );
    close.setAttribute("aria-label", "Close");
    close.addEventListener("click", () => this.#session.select(null));
    const title = element("h2", { class: "robot-id", textContent: robot.id, title: robot.id });
    return element("header", {}, swatch, title, this.#state, close);
  }

  #body(robot, track) {
    if (track.unplanned) return [this.#why(track.unplanned)];
    const stuck = track.stuck === null ? [] : [this.#why({ ...track.stuck, detail: STUCK })];
    if (track.actions.length === 0) {
      if (stuck.length > 0) return stuck;
      const isIdle = track.status === "parked" && robot.makesWay;
      return [element("p", { textContent: NO_ACTIONS[isIdle ? "idle" : track.status] })];
    }
    const sum = totals(track.actions);
    this.#speeds = new SpeedChart(track.actions);
    return [
      ...stuck,
      costOf(robot, track),
      ...lateAt(track),
      sharesOf(sum),
      this.#table(robot, track.actions),
      this.#speeds.node,
    ];
  }

  /** Why it has no plan, or comes no nearer to its goals, and who is in its way. */
  #why({ reason, detail, ...entry }) {
    return element(
      "div",
      { class: "why" },
      element("p", { class: "reason", textContent: REASONS[reason] ?? reason }),
      detail ? element("p", { textContent: detail }) : null,
      blockedBy(this.#session, entry),
    );
  }

  #table(robot, actions) {
    const body = element("tbody");
    this.#rows = actions.map((action, at) => {
      const words = element("button", {
        type: "button",
        class: "action",
        textContent: actionInWords(action),
      });
      words.addEventListener("click", () => this.#session.seek(action.t_start));
      const what = element("td", {}, words);
      if (action.type === "wait") what.append(...this.#causeOf(robot, actions, at));
      const row = element(
        "tr",
        { "data-type": action.type },
        element("td", {}, element("span", { class: `form ${action.type}` })),
        element("td", { class: "when", textContent: action.t_start.toFixed(2) }),
        element("td", { class: "when", textContent: action.t_end.toFixed(2) }),
        what,
      );
      body.append(row);
      return row;
    });
    const heads = COLUMNS.map((textContent) => element("th", { scope: "col", textContent }));
    const table = element(
      "table",
      {},
      element("thead", {}, element("tr", {}, element("td"), ...heads)),
      body,
    );
    return element("div", { class: "actions", tabIndex: 0, role: "region", "aria-label": "Actions" }, table);
  }

  /** The text after a wait. */
  #causeOf(robot, actions, at) {
    if (Number.isInteger(actions[at].goal)) return []; // a service, whatever the others do
    const hit = causeOfWait(robot.id, actions, at, this.#fleet.byId);
    if (hit) return this.#causeInWords("for", hit);
    const inflation = this.#session.request.options?.inflation ?? 0;
    const keepsMore = inflation > 0 || this.#session.scene.robots.some(({ vicinity }) => vicinity > 0);
    const near = keepsMore && causeOfWait(robot.id, actions, at, this.#fleet.keptFree, 2 * inflation);
    if (near) return this.#causeInWords("to keep clear of", near);
    const note = element("span", {
      class: "note",
      textContent: "for no robot",
      title:
        "No robot would be hit without this wait: it is a pause before a move, or preserves a safety margin",
    });
    return [" ", note];
  }

  #causeInWords(why, { robot, t }) {
    const chip = robotChip(this.#session, robot);
    const what = why === "for" ? "collide" : "come too near";
    chip.title = `Without this wait, the two robots would ${what} at ${seconds(t)}`;
    return [` ${why} `, chip];
  }

  #update() {
    if (this.#box.hidden) return;
    const { time } = this.#session.player;
    setText(this.#state, this.#session.stateOf(this.#shown));
    this.#speeds?.show(time);
    if (this.#rows.length === 0) return;
    const { actions, cost } = this.#session.tracks.get(this.#shown);
    const current = time >= cost ? -1 : actionIndexAt(actions, time);
    if (current === this.#current) return;
    this.#rows[this.#current]?.removeAttribute("aria-current");
    this.#current = current;
    const row = this.#rows[current];
    if (!row) return;
    row.setAttribute("aria-current", "step");
    const box = row.closest(".actions");
    scrollWithin(box, row, box.querySelector("thead").offsetHeight);
  }
}

/** The row of a robot in the list, where the focus goes from its card. */
const rowOf = (id) =>
  /** @type {HTMLElement | null} */ (
    document.querySelector(`#robots .robot[data-robot="${CSS.escape(id)}"]`)
  );

function costOf(robot, track) {
  const delay = delayOf(track);
  const compared =
    delay === -Infinity
      ? null
      : element("small", {
          textContent:
            delay < 5e-3
              ? "equal to its lower bound"
              : `${seconds(delay)} above its lower bound (${seconds(track.lowerBound)})`,
        });
  const cost = element("b", { textContent: seconds(track.cost) });
  return element("p", { class: "cost" }, cost, untilWhen(robot, track), compared);
}

/** What a robot's cost lasts until, in words. */
function untilWhen({ goal, makesWay }, { stuck }) {
  if (stuck !== null) return " to the end of its plan";
  return goal === null && makesWay ? " to make way" : " to the goal";
}

/** Where it arrives after it was due. */
function lateAt({ late }) {
  if (late.length === 0) return [];
  const places = late.map((each) => `at goal ${each.goal + 1} by ${seconds(each.seconds)}`);
  return [element("p", { class: "late", textContent: `Late ${places.join(", ")}` })];
}

/** The shares of moving, turning and waiting, as a bar and in words. */
function sharesOf({ moving, turning, waiting, distance }) {
  const spent = Object.entries({ moving, turning, waiting }).filter(([, time]) => time > 0);
  const bar = element("div", { class: "shares", "aria-hidden": "true" });
  for (const [doing, time] of spent) {
    const part = element("span", { class: `share ${doing}` });
    part.style.flexGrow = String(time);
    bar.append(part);
  }
  const words = spent.map(([doing, time]) => `${doing} ${time.toFixed(1)} s`);
  words.push(`${distance.toFixed(1)} m travelled`);
  return element("div", {}, bar, element("p", { class: "note", textContent: words.join(" · ") }));
}

/**
 * The corner for a card in a scene {width, height} that covers the fewest of the points. The card has some width and
 * height, and is `margin` {top, side, bottom} away from the edges.
 */
export function cornerFor({ width, height }, scene, margin, points) {
  const covered = CORNERS.map((corner) => {
    const left = corner.endsWith("left") ? margin.side : scene.width - margin.side - width;
    const top = corner.startsWith("top") ? margin.top : scene.height - margin.bottom - height;
    const isUnder = ({ x, y }) => x >= left && x <= left + width && y >= top && y <= top + height;
    return points.filter(isUnder).length;
  });
  return CORNERS[covered.indexOf(Math.min(...covered))];
}
