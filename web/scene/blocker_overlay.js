// The robots that are in the way of a selected one without a plan: ringed and joined to it.

import { drawPath, ring } from "./marks.js";

export function showBlockers(session, stage) {
  stage.addOverlay((context, view) => {
    const blocked = session.tracks.get(session.selected)?.unplanned;
    if (!blocked) return;
    const { theme, screen, scale } = view;
    const from = screen(session.poseOf(session.selected, view.time));
    for (const id of blocked.blocked_by ?? []) {
      const robot = session.robot(id);
      if (robot === null) continue;
      const centre = screen(session.poseOf(id, view.time));
      drawPath(context, [from, centre], theme.danger, { width: 1.5, alpha: 0.9, dashes: [6, 4] });
      ring(context, centre, robot.radius * scale + 4, theme.danger, { width: 2, alpha: 1, dashes: [6, 3] });
    }
  });
}
