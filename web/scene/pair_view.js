// Shows a moment of some robots: what they are doing, together and large.

import { seconds } from "../ui/format.js";

/** Pauses at a time, highlights the robots and brings them into the middle. `stage`: see Stage. */
export function showMoment(session, stage, ids, time) {
  session.pause();
  session.highlight(ids);
  session.seek(time);
  session.announce(`${ids.join(" and ")} at ${seconds(session.player.time)}.`);
  const known = ids.filter((id) => session.robot(id) !== null);
  stage.frame(known.map((id) => ({ ...session.poseOf(id), radius: session.radiusOf(id) })));
}
