// The poses of robots under a plan, and the gap between two, computed without code of the page, which must agree.

const TURN = 2 * Math.PI;

/** The pose at t of a robot that starts at `start` and follows `actions`. */
export function expectedPose(start, actions, t, robot = {}) {
  let pose = { x: start.x, y: start.y, theta: start.theta ?? 0 };
  let loaded = robot;
  for (const action of actions) {
    const { type, t_start, t_end, from, to } = action;
    if (t >= t_end) {
      pose = to;
      if (action.goal !== undefined) loaded = loadedAfter(loaded, robot.goals?.[action.goal]);
      continue;
    }
    if (t < t_start) break;
    const share = action.profile ? integrated(action, t, loaded) : (t - t_start) / (t_end - t_start);
    if (type === "translate") {
      return { x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y), theta: from.theta };
    }
    if (type === "rotate")
      return { x: from.x, y: from.y, theta: from.theta + share * turn(from.theta, to.theta) };
    return from;
  }
  return pose;
}

/** A robot after the service at a goal that changes its accelerations. */
function loadedAfter(robot, goal) {
  const gain = goal?.linear_acceleration_after;
  const loss = goal?.linear_deceleration_after ?? gain;
  return {
    ...robot,
    linear_acceleration: gain ?? robot.linear_acceleration,
    linear_deceleration: loss ?? robot.linear_deceleration,
  };
}

/** The share of an action with a profile that is covered at t: the area under its speed, which is linear in parts. */
function integrated({ type, t_start, t_end, profile }, t, robot) {
  const turns = type === "rotate";
  const gain = turns ? robot.angular_acceleration : robot.linear_acceleration;
  const loss = turns ? gain : (robot.linear_deceleration ?? gain);
  const speed = (at) =>
    Math.min(profile.cruise, profile.start + gain * (at - t_start), profile.end + loss * (t_end - at));
  const bends = [
    t_start + (profile.cruise - profile.start) / gain,
    t_end - (profile.cruise - profile.end) / loss,
  ];
  const covered = (until) => {
    const times = [t_start, ...bends.map((at) => Math.min(at, until)), until].sort((a, b) => a - b);
    return times
      .slice(1)
      .reduce((sum, at, k) => sum + ((at - times[k]) * (speed(at) + speed(times[k]))) / 2, 0);
  };
  return covered(t) / covered(t_end);
}

function turn(from, to) {
  const left = (((to - from) % TURN) + TURN) % TURN; // how far counter-clockwise, [0, 2 pi)
  return left <= Math.PI ? left : left - TURN;
}

/** How far apart two headings are, radians in [0, pi]. */
export function headingGap(a, b) {
  return Math.abs(Math.atan2(Math.sin(a - b), Math.cos(a - b)));
}

/** The gap between the disks of two robots at t, worked out from the plan alone. */
export function expectedGap(request, answer, [one, other], t) {
  const plans = new Map(answer.plans.map((plan) => [plan.robot, plan.actions]));
  const [a, b] = [one, other].map((id) => {
    const robot = request.robots.find((each) => each.id === id);
    const radius = robot.radius ?? request.robot_defaults.radius;
    return { ...expectedPose(robot.start, plans.get(id) ?? [], t, robot), radius };
  });
  return Math.hypot(b.x - a.x, b.y - a.y) - a.radius - b.radius;
}
