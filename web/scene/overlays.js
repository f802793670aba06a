// Overlays on the scene: blocking robots, violations of a checked plan, the closest pair.

import { violationsAt } from "../model/checks.js";
import { robotPoseAt, robotRadiusAt } from "../model/scene.js";
import { blockersOf } from "../model/stuck.js";
import { byId } from "../ui/dom.js";
import { metres } from "../ui/format.js";
import { drawPath, drawTag, markWrong, ring } from "./marks.js";

const TAG_FROM = 56; // pixels between two disks: below, the tag is beside the line, not on it
const ASIDE = 22; // pixels

/** Where a robot is in the plan of a view, and its radius, pixels: {x, y, radius}; null if there is no such robot. */
function diskIn(session, { tracks, time, screen, scale }, id) {
  const robot = session.robot(id);
  const track = tracks.get(id);
  if (robot === null || track === undefined) return null;
  return { ...screen(robotPoseAt(robot, track, time)), radius: robotRadiusAt(robot, track, time) * scale };
}

export function showBlockers(session, stage) {
  const paint = (context, view) => {
    const { theme, tracks } = view;
    const from = diskIn(session, view, session.selected);
    for (const id of blockersOf(tracks.get(session.selected))) {
      const disk = diskIn(session, view, id);
      if (disk === null) continue;
      drawPath(context, [from, disk], theme.danger, { width: 1.5, alpha: 0.9, dashes: [6, 4] });
      ring(context, disk, disk.radius + 4, theme.danger, { width: 2, alpha: 1, dashes: [6, 3] });
    }
  };
  stage.addOverlay(paint, { shared: true });
}

/** `fleet`: see FleetMotion. */
export function showViolations(session, stage, fleet) {
  session.on("check", () => stage.redraw());
  stage.addOverlay((context, view) => {
    const wrong = new Set(
      violationsAt(session.check?.violations ?? [], view.time, fleet.byId).flatMap(({ robots }) => robots),
    );
    for (const id of wrong) {
      const robot = session.robot(id);
      if (robot) markWrong(context, view, session.poseOf(id, view.time), session.radiusOf(id, view.time));
    }
  });
}

export class ClosestOverlay {
  #session;
  #stage;
  #fleet;
  #button = byId("show-closest");
  #on = false;
  #peeking = false;

  /** `fleet`: see FleetMotion. */
  constructor(session, stage, fleet) {
    this.#session = session;
    this.#stage = stage;
    this.#fleet = fleet;
    this.#button.addEventListener("click", () => this.toggle());
    fleet.onCurve(() => stage.redraw());
    stage.addOverlay((context, view) => this.#paint(context, view), { shared: true });
  }

  toggle() {
    this.#on = !this.#on;
    this.#button.setAttribute("aria-pressed", String(this.#on));
    this.#stage.redraw();
    const pair = this.#on ? this.#fleet.nearestAt(this.#session.player.time) : null;
    if (pair !== null) this.#session.announce(`Closest now: ${pair.ids.join(" and ")}, ${metres(pair.gap)}.`);
  }

  /** Shows the pair temporarily (true) or no longer. */
  peek(peeking) {
    if (peeking === this.#peeking) return;
    this.#peeking = peeking;
    this.#stage.redraw();
  }

  #paint(context, view) {
    if (!this.#on && !this.#peeking) return;
    const pair = this.#fleet.nearestAt(view.time, view.tracks);
    const disks = pair?.ids.map((id) => diskIn(this.#session, view, id)) ?? [null];
    if (!disks.includes(null)) paintGap(context, view.theme, disks, pair.gap);
  }
}

function paintGap(context, theme, [a, b], gap) {
  for (const disk of [a, b]) {
    ring(context, disk, disk.radius + 1.5, theme.ink, { width: 1.5, alpha: 0.9, dashes: [] });
  }
  drawPath(context, [a, b], theme.ink, { width: 1.5, alpha: 0.95, dashes: [3, 4] });
  const apart = Math.hypot(b.x - a.x, b.y - a.y);
  const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  const aside = apart - a.radius - b.radius < TAG_FROM ? Math.max(a.radius, b.radius) + ASIDE : 0;
  // Below the line, because the names of robots are above them.
  const [x, y] = apart > 0 ? [-(b.y - a.y) / apart, (b.x - a.x) / apart] : [0, 1];
  const side = y < 0 ? -1 : 1;
  drawTag(context, theme, { x: middle.x + x * aside * side, y: middle.y + y * aside * side }, metres(gap));
}
