// The pose of a robot under a plan, computed without code of the page, which must agree.

const TURN = 2 * Math.PI;

/** The pose at t of a robot that starts at `start` and follows `actions`. */
export function expectedPose(start, actions, t) {
  let pose = { x: start.x, y: start.y, theta: start.theta ?? 0 };
  for (const { type, t_start, t_end, from, to } of actions) {
    if (t >= t_end) {
      pose = to;
      continue;
    }
    if (t < t_start) break;
    const share = (t - t_start) / (t_end - t_start);
    if (type === "translate") {
      return { x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y), theta: from.theta };
    }
    if (type === "rotate")
      return { x: from.x, y: from.y, theta: from.theta + share * turn(from.theta, to.theta) };
    return from;
  }
  return pose;
}

function turn(from, to) {
  const left = (((to - from) % TURN) + TURN) % TURN; // how far counter-clockwise, [0, 2 pi)
  return left <= Math.PI ? left : left - TURN;
}

/** How far apart two headings are, radians in [0, pi]. */
export function headingGap(a, b) {
  return Math.abs(Math.atan2(Math.sin(a - b), Math.cos(a - b)));
}
