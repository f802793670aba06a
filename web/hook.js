// Scripting surface, read-only, for tests and scripts. `window.fleetplan` has
//
// - `time` and `duration` (seconds), and `playing`,
// - `request`, `answer` and `check`: parsed JSON or null,
// - `outdated`: null unless the answer is for the request before its edits; then the ids of the robots whose plans no
//   longer hold,
// - `selected` (id or null) and `chosen` (ids),
// - `closest`: {ids, gap} of the two robots that are closest now, metres,
// - `least`: {t, gap, ids}, when two robots are closest in all of the plan,
// - `poseOf(id)`: the pose drawn now, metres and radians,
// - `stateOf(id)`,
// - `screenOf(id)`: {x, y, radius} of the robot's disk on the canvas, CSS pixels,
// - `pointOf({x, y})`: where a world point is on the canvas.

export function offerHook(session, stage, fleet) {
  /** @type {any} */ (window).fleetplan = Object.freeze({
    get time() {
      return session.player.time;
    },
    get duration() {
      return session.player.duration;
    },
    get playing() {
      return session.player.playing;
    },
    get request() {
      return session.request;
    },
    get answer() {
      return session.answer;
    },
    get outdated() {
      return session.outdated && [...session.outdated];
    },
    get check() {
      return session.check;
    },
    get selected() {
      return session.selected;
    },
    get chosen() {
      return session.chosen;
    },
    get closest() {
      return fleet.nearestAt(session.player.time);
    },
    get least() {
      return fleet.least;
    },
    poseOf: (id) => session.poseOf(id),
    stateOf: (id) => session.stateOf(id),
    screenOf(id) {
      const robot = session.robot(id);
      return robot && stage.screenOf(session.poseOf(id), session.radiusOf(id));
    },
    pointOf: (point) => stage.screenOf(point, 0),
  });
}
