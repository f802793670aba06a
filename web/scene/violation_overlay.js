// What a checked plan does wrong, marked at the robots that do it while they do.

import { violationsAt } from "../model/violations.js";
import { markWrong } from "./warning_marks.js";

/** `fleet`: see FleetMotion. */
export function showViolations(session, stage, fleet) {
  session.on("check", () => stage.redraw());
  stage.addOverlay((context, view) => {
    const wrong = new Set(
      violationsAt(session.check?.violations ?? [], view.time, fleet.byId).flatMap(({ robots }) => robots),
    );
    for (const id of wrong) {
      const robot = session.robot(id);
      if (robot) markWrong(context, view, session.poseOf(id, view.time), robot.radius);
    }
  });
}
