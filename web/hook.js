// Scripting surface, read-only, for tests and scripts: `window.fleetplan` has `time`, `duration`
// (seconds), `playing`, `request`, `answer` and `check` (parsed JSON or null), `outdated` (if the answer is that of the
// request before its edits, the ids of the robots whose plans no longer hold; else null), `selected` (id or null), `chosen` (ids),
// `closest` ({ids, gap} of the two robots that are closest now, metres) and `least` ({t, gap, ids} when two
// are closest in all of the plan), `poseOf(id)` (the pose drawn now, metres and radians), `stateOf(id)` and
// `screenOf(id)` ({x, y, radius} of its disk on the canvas, CSS pixels); `pointOf({x, y})` is where a world
// point is on the canvas.

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
