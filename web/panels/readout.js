// The line over the scene that says what the robot pointed at does and where it is.

import { byId, setText } from "../ui/dom.js";
import { degrees } from "../ui/format.js";

export function watchReadout(session) {
  const readout = byId("readout");
  session.on("answer marks time", () => {
    const id = session.hovered ?? session.selected;
    const pose = id === null ? null : session.poseOf(id);
    readout.hidden = pose === null;
    if (pose === null) return;
    const where = `(${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}) m, ${degrees(pose.theta)}`;
    setText(readout, `${id}: ${session.stateOf(id)} at ${where}`);
  });
}
