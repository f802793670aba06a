// Errors where they are: at their robots and rows in the scene, at their fields in the panels, and listed; pressing a
// listed one leads to its place.

import { robotsOf } from "../model/edit_robots.js";
import { mapRowOf, robotIndexOf } from "../model/pointer.js";
import { markRow, markWrong } from "../scene/warning_marks.js";
import { fieldOf, showFieldErrors } from "../ui/field_errors.js";
import { watchProblem } from "./problem_card.js";

const FORMS = ["panel-edit", "panel-options"];

/** `choice`: see RobotChoice. */
export function showPlacesOfErrors(session, stage, tabs, choice) {
  const errors = () => session.problem?.errors ?? [];
  const forms = FORMS.map((id) => document.getElementById(id));

  const refresh = () => {
    for (const form of forms) showFieldErrors(form, errors());
  };
  session.on("problem marks", refresh); // marks: the form may have turned to another robot
  session.on("problem", () => stage.redraw());

  stage.addOverlay((context, view) => {
    for (const { pointer = "" } of errors()) {
      const disk = diskOf(session, pointer);
      const row = mapRowOf(pointer);
      if (row !== null && session.scene.grid) markRow(context, view, session.scene.grid, row);
      if (disk) markWrong(context, view, disk, disk.radius);
    }
  });

  watchProblem(session, (pointer) => {
    const index = robotIndexOf(pointer);
    const disk = diskOf(session, pointer);
    if (index !== null) choice.choose(index);
    if (disk) stage.reveal(disk);
    refresh();
    const form = forms.find((each) => fieldOf(each, pointer) !== null);
    if (form) focusOn(fieldOf(form, pointer), tabs);
  });
}

/** Leads to a field, or to the first of a group of fields, wherever it is folded away. */
function focusOn(field, tabs) {
  tabs.reveal(field);
  const details = field.closest("details");
  if (details) details.open = true;
  const control = field.matches("input, select") ? field : field.querySelector("input, select");
  control.focus();
}

/**
 * Where a robot that an error is about has its start or, if the error is about that, its goal: {x, y, radius}, metres;
 * null if there is none. A robot may be too faulty to be drawn and yet have a place.
 */
function diskOf({ request, scene }, pointer) {
  const robot = robotsOf(request)[robotIndexOf(pointer)];
  const pose = (/^\/robots\/\d+\/goal/.test(pointer) && robot?.goal) || robot?.start;
  if (!Number.isFinite(pose?.x) || !Number.isFinite(pose?.y)) return null;
  const radius = robot.radius ?? request.robot_defaults?.radius;
  return { x: pose.x, y: pose.y, radius: radius > 0 ? radius : (scene.grid?.resolution ?? 1) / 2 };
}
