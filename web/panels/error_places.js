// Errors where they are: at their robots and rows in the scene, at their fields in the panels, and listed; pressing a
// listed one leads to its place.

import { mapRowOf, robotIndexOf } from "../model/pointer.js";
import { markRow, markWrong } from "../scene/warning_marks.js";
import { fieldOf, showFieldErrors } from "../ui/field_errors.js";
import { watchProblem } from "./problem_card.js";

const FORMS = ["panel-edit", "panel-options"];

export function showPlacesOfErrors(session, stage, tabs) {
  const errors = () => session.problem?.errors ?? [];
  const forms = FORMS.map((id) => document.getElementById(id));
  const robotAt = (pointer) => {
    const index = robotIndexOf(pointer);
    return index === null ? undefined : session.scene.robots.find((robot) => robot.index === index);
  };

  const refresh = () => {
    for (const form of forms) showFieldErrors(form, errors());
  };
  session.on("problem marks", refresh); // marks: the form may have turned to another robot
  session.on("problem", () => stage.redraw());

  stage.addOverlay((context, view) => {
    for (const { pointer = "" } of errors()) {
      const robot = robotAt(pointer);
      const row = mapRowOf(pointer);
      if (row !== null && session.scene.grid) markRow(context, view, session.scene.grid, row);
      if (robot) markWrong(context, view, placeOf(robot, pointer), robot.radius);
    }
  });

  watchProblem(session, (pointer) => {
    const robot = robotAt(pointer);
    if (robot) {
      session.select(robot.id);
      stage.reveal(placeOf(robot, pointer));
    }
    refresh();
    const form = forms.find((each) => fieldOf(each, pointer) !== null);
    if (!form) return;
    const field = fieldOf(form, pointer);
    tabs.reveal(field);
    field.focus();
  });
}

/** The start or, if the error is about that, the goal. */
function placeOf(robot, pointer) {
  return (/^\/robots\/\d+\/goal/.test(pointer) && robot.goal) || robot.start;
}
