// The problem card, and its errors at their places: robots and rows in the scene, fields in the panels.
// Pressing a listed error leads to its place.

import { nameOf, robotsOf } from "../model/edit_request.js";
import { goalAt } from "../model/goals.js";
import { mapRowOf, partsOf, robotIndexOf } from "../model/problem.js";
import { markRow, markWrong } from "../scene/marks.js";
import { byId, element } from "../ui/dom.js";
import { fieldOf, showFieldErrors } from "../ui/field_errors.js";
import { count } from "../ui/format.js";

const FORMS = ["panel-edit", "panel-options"];
const MOST_ERRORS = 100; // to list

/**
 * Shows the session's problem and marks its errors at their places. `choice`: see RobotChoice.
 * `loadOptions()` resolves when the form of the options is there.
 */
export function watchProblem(session, stage, tabs, choice, loadOptions) {
  const errors = () => session.problem?.errors ?? [];
  const forms = FORMS.map((id) => document.getElementById(id));

  const refresh = () => {
    for (const form of forms) showFieldErrors(form, errors());
  };
  session.on("problem marks", refresh); // marks: the form may show another robot now
  session.on("problem", () => {
    stage.redraw();
    if (errors().some(isAboutOptions)) loadOptions().then(refresh);
  });

  stage.addOverlay((context, view) => {
    for (const { pointer = "" } of errors()) {
      const disk = diskOf(session, pointer);
      const row = mapRowOf(pointer);
      if (row !== null && session.scene.grid) markRow(context, view, session.scene.grid, row);
      if (disk) markWrong(context, view, disk, disk.radius);
    }
  });

  const lead = async (pointer) => {
    if (isAboutOptions({ pointer })) await loadOptions();
    const index = robotIndexOf(pointer);
    const disk = diskOf(session, pointer);
    if (index !== null) choice.choose(index);
    if (disk) stage.reveal(disk);
    refresh();
    const form = forms.find((each) => fieldOf(each, pointer) !== null);
    if (form) focusOn(fieldOf(form, pointer), tabs);
  };
  session.on("problem", () => showProblem(session.problem, session.request, lead));
}

const isAboutOptions = ({ pointer = "" }) => pointer.startsWith("/options");

/** Focuses a field, or the first of a group of fields, and unfolds what hides it. */
function focusOn(field, tabs) {
  tabs.reveal(field);
  const details = field.closest("details");
  if (details) details.open = true;
  const control = field.matches("input, select") ? field : field.querySelector("input, select");
  control.focus();
}

/**
 * The disk at the start of the robot that an error points to, or at its goal if it points there: {x, y,
 * radius}, metres; null if there is none. A robot that is too faulty to be drawn may still have one.
 */
function diskOf({ request, scene }, pointer) {
  const robot = robotsOf(request)[robotIndexOf(pointer) ?? -1];
  const pose = goalAt(robot, partsOf(pointer).slice(2)) ?? robot?.start;
  if (!Number.isFinite(pose?.x) || !Number.isFinite(pose?.y)) return null;
  const radius = robot.radius ?? request.robot_defaults?.radius;
  return { x: pose.x, y: pose.y, radius: radius > 0 ? radius : (scene.grid?.resolution ?? 1) / 2 };
}

/** Scrolls the problem into view on pages longer than the window, as on a phone. */
export function revealProblem() {
  byId("problem").scrollIntoView({ block: "center" });
}

function showProblem(problem, request, show) {
  const box = byId("problem");
  box.hidden = problem === null;
  box.replaceChildren();
  if (problem === null) return;
  box.append(element("h2", { textContent: problem.title }));
  if (problem.detail) box.append(element("p", { textContent: problem.detail }));
  if (problem.retry_after) {
    box.append(element("p", { textContent: `Try again in ${count(problem.retry_after, "second")}.` }));
  }
  if (problem.errors?.length > 0) box.append(errorList(problem, request, show));
  if (problem.again) box.append(againButton(problem.again));
  if (problem.request_id) {
    box.append(element("p", { class: "request-id", textContent: `Request ${problem.request_id}` }));
  }
}

function againButton(again) {
  const button = element("button", { type: "button", class: "again", textContent: "Try again" });
  button.addEventListener("click", again);
  return button;
}

function errorList({ errors, errors_total = errors.length }, request, show) {
  const list = element("ul", { class: "errors" });
  for (const { pointer = "", detail } of errors.slice(0, MOST_ERRORS)) {
    const place = element("button", { type: "button", class: "error", "data-error": pointer });
    place.append(
      element("span", { class: "error-place" }, placeInWords(pointer, request)),
      element("code", { textContent: pointer || "(whole request)" }),
      element("span", { textContent: detail }),
    );
    place.addEventListener("click", () => show(pointer));
    list.append(element("li", {}, place));
  }
  const more = errors_total - Math.min(errors.length, MOST_ERRORS);
  if (more > 0) list.append(element("li", { textContent: `and ${count(more, "more", "more")}` }));
  return list;
}

/** The place that a pointer leads to, in words. */
function placeInWords(pointer, request) {
  const index = robotIndexOf(pointer);
  if (index !== null) return nameOf(request, index);
  const row = mapRowOf(pointer);
  if (row !== null) return `Row ${row + 1} of the map`;
  if (pointer.startsWith("/map")) return "Map";
  if (pointer.startsWith("/options")) return "Option";
  if (pointer.startsWith("/obstacles")) return "Obstacle";
  return "Request";
}
