// What is known of the plan: problems, figures, robots without a plan, and the list of all robots.

import { byId, element, icon, setText } from "./dom.js";
import { count, metres, milliseconds, seconds } from "./format.js";

const TICK = "M4.5 10.5 8.5 14.5 15.5 6";
const CROSS = "M5 5 15 15M15 5 5 15";
const PART = "M4.5 10h11";

const MOST_ERRORS = 100; // to list; nobody reads more

const OUTCOMES = {
  solved: { text: "Solved", tone: "good", path: TICK },
  partial: { text: "Partly solved", tone: "fair", path: PART },
  none: { text: "No robot planned", tone: "bad", path: CROSS },
};

const REASONS = {
  start_blocked: "Start blocked",
  goal_blocked: "Goal blocked",
  goal_unreachable: "Goal unreachable",
  blocked_by_robots: "Blocked by other robots",
  budget_exhausted: "Out of time",
};

/** A sentence that says how planning ended. */
export function summarize(answer) {
  const outcome = OUTCOMES[answer.status]?.text ?? answer.status;
  const planned = `${count(answer.plans.length, "robot")} planned`;
  const failed = answer.unplanned.length > 0 ? `, ${answer.unplanned.length} without a plan` : "";
  return `${outcome}: ${planned}${failed}, flowtime ${seconds(answer.flowtime)}.`;
}

/**
 * Shows a problem (RFC 9457), or none. `idAt` gives the id of the robot at an index of the request, or null;
 * `select` is called with the id of a robot that an error points to.
 */
export function showProblem(problem, idAt, select) {
  const box = byId("problem");
  box.hidden = problem === null;
  box.replaceChildren();
  if (problem === null) return;
  box.append(element("h2", { textContent: problem.title }));
  if (problem.detail) box.append(element("p", { textContent: problem.detail }));
  if (problem.retry_after) {
    box.append(element("p", { textContent: `Try again in ${count(problem.retry_after, "second")}.` }));
  }
  if (problem.errors?.length > 0) box.append(errorList(problem.errors, idAt, select));
  if (problem.request_id) {
    box.append(element("p", { class: "request-id", textContent: `Request ${problem.request_id}` }));
  }
}

function errorList(errors, idAt, select) {
  const list = element("dl");
  for (const { pointer, detail } of errors.slice(0, MOST_ERRORS)) {
    const code = element("code", { textContent: pointer || "(whole request)" });
    const index = /^\/robots\/(\d+)/.exec(pointer ?? "");
    const id = index && idAt(Number(index[1]));
    const term = element("dt", {}, code);
    if (id !== null) term.append(" ", chip(id, select));
    list.append(element("div", {}, term, element("dd", { textContent: detail })));
  }
  const more = errors.length - MOST_ERRORS;
  if (more > 0)
    list.append(element("div", {}, element("dt", { textContent: `and ${count(more, "more", "more")}` })));
  return list;
}

/** A button that names a robot and selects it. */
function chip(id, select) {
  const button = element("button", { type: "button", class: "chip", textContent: id });
  button.addEventListener("click", () => select(id));
  return button;
}

/** Shows the figures of an answer, or none. */
export function showSummary(answer) {
  const box = byId("summary");
  box.hidden = answer === null;
  if (answer === null) {
    box.replaceChildren();
    return;
  }
  const timings = answer.timings_ms;
  const figures = element(
    "dl",
    { class: "figures" },
    figure("Flowtime", seconds(answer.flowtime), ...bound(answer.flowtime, answer.lower_bound.flowtime)),
    figure("Makespan", seconds(answer.makespan), ...bound(answer.makespan, answer.lower_bound.makespan)),
    figure(
      "Smallest gap",
      answer.min_clearance === null ? "–" : metres(answer.min_clearance),
      "between two robots",
    ),
    figure(
      "Planned in",
      milliseconds(timings.plan),
      count(answer.search.expansions, "expansion"),
      `${milliseconds(timings.total)} in all`,
    ),
  );
  box.replaceChildren(badges(answer), figures);
  if (answer.warnings.length > 0) box.append(warningList(answer.warnings));
}

function badges(answer) {
  const outcome = OUTCOMES[answer.status] ?? OUTCOMES.none;
  const list = element("div", { class: "badges" }, badge(outcome.text, outcome.tone, outcome.path));
  if (answer.verified) {
    list.append(
      badge("Verified", "good", TICK, "An independent check in continuous time found no collision"),
    );
  } else {
    list.append(badge("Not verified", "bad", CROSS));
  }
  const why = answer.deterministic
    ? "The same request and seed give the same plan"
    : "The clock decided when to stop: another run may differ";
  list.append(badge(answer.deterministic ? "Deterministic" : "Not deterministic", "", null, why));
  return list;
}

function badge(text, tone, path, title = "") {
  return element("span", { class: `badge ${tone}`, title }, path ? icon(path) : null, text);
}

function figure(name, value, ...notes) {
  const small = notes.filter((note) => note !== "").map((textContent) => element("small", { textContent }));
  return element("div", {}, element("dt", { textContent: name }), element("dd", {}, value, ...small));
}

function bound(value, least) {
  if (!(least > 0)) return [];
  return [`lower bound ${seconds(least)}`, `${(value / least).toFixed(3)} times that`];
}

function warningList(warnings) {
  const texts = warnings.map((warning) =>
    typeof warning === "string" ? warning : (warning.detail ?? JSON.stringify(warning)),
  );
  return element(
    "ul",
    { class: "warnings", "aria-label": "Warnings" },
    ...texts.map((textContent) => element("li", { textContent })),
  );
}

/** Lists the robots without a plan and why. `select` is called with an id. */
export function showUnplanned(unplanned, select) {
  const box = byId("unplanned");
  box.hidden = unplanned.length === 0;
  box.replaceChildren();
  if (unplanned.length === 0) return;
  const entries = unplanned.map(({ robot, reason, detail, blocked_by }) =>
    element(
      "li",
      { class: "card" },
      element(
        "div",
        { class: "chips" },
        chip(robot, select),
        element("span", { class: "reason", textContent: REASONS[reason] ?? reason }),
      ),
      detail ? element("p", { textContent: detail }) : null,
      blocked_by?.length > 0
        ? element("div", { class: "chips" }, "In the way:", ...blocked_by.map((id) => chip(id, select)))
        : null,
    ),
  );
  box.append(element("h2", { textContent: "Without a plan" }), element("ul", { class: "stuck" }, ...entries));
}

/** The list of robots with what each does now. */
export class RobotList {
  #list = byId("robots");
  #rows = new Map(); // id -> {button, state, cost}

  /** `told` has hover(id or null) and select(id). */
  constructor(told) {
    const idOf = (event) => event.target.closest("button")?.dataset.robot ?? null;
    this.#list.addEventListener("click", (event) => {
      const id = idOf(event);
      if (id !== null) told.select(id);
    });
    this.#list.addEventListener("pointerover", (event) => told.hover(idOf(event)));
    this.#list.addEventListener("pointerleave", () => told.hover(null));
    this.#list.addEventListener("focusin", (event) => told.hover(idOf(event)));
    this.#list.addEventListener("focusout", () => told.hover(null));
  }

  /** `colourOf(index)` gives a robot's colour. */
  show(scene, tracks, colourOf) {
    this.#rows.clear();
    setText(byId("robots-title"), scene.robots.length > 0 ? count(scene.robots.length, "robot") : "Robots");
    const items = scene.robots.map((robot) => {
      const row = this.#row(robot, tracks.get(robot.id), colourOf(robot.index));
      this.#rows.set(robot.id, row);
      return element("li", {}, row.button);
    });
    this.#list.replaceChildren(...items);
  }

  #row(robot, track, colour) {
    const filled = track.status === "unplanned" ? "" : " filled";
    const swatch = element("span", { class: `swatch${filled}` });
    swatch.style.color = colour;
    const state = element("span", { class: `robot-state ${track.status}` });
    const cost = element("span", {
      class: "robot-cost",
      textContent: track.cost === null ? "" : seconds(track.cost),
    });
    const id = element("span", { class: "robot-id", textContent: robot.id, title: robot.id });
    const button = element("button", {
      type: "button",
      class: "robot",
      "aria-pressed": "false",
      "data-robot": robot.id,
    });
    button.append(swatch, id, state, cost);
    return { button, state };
  }

  /** `stateOf(id)` is the word to show for each robot. */
  update(stateOf, hovered, selected) {
    for (const [id, { button, state }] of this.#rows) {
      setText(state, stateOf(id));
      button.classList.toggle("hovered", id === hovered);
      const pressed = String(id === selected);
      if (button.getAttribute("aria-pressed") !== pressed) button.setAttribute("aria-pressed", pressed);
    }
  }

  reveal(id) {
    this.#rows.get(id)?.button.scrollIntoView({ block: "nearest" });
  }
}
