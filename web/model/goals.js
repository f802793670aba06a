// The goals of a robot of a request: `goals` in the order of its visits, or `goal` alone. A robot stays at its last
// goal, which forms and handles edit. Faulty robots are read as far as possible. Pure.

/** The goals as they are in the request, the last one included. */
export function goalsOf(robot) {
  if (Array.isArray(robot?.goals)) return robot.goals;
  return robot?.goal === undefined ? [] : [robot.goal];
}

/** The poses at one of which a goal is served, as they are in the request; none for a goal with one pose. */
export const alternativesOf = (goal) => (Array.isArray(goal?.any_of) ? goal.any_of : []);

/** The last goal as it is in the request; undefined if there is none. */
export function lastGoalOf(robot) {
  return goalsOf(robot).at(-1);
}

/** Where the last goal is in the robot, as a part of a JSON Pointer: "goal" or "goals/2". */
export function lastGoalPlace(robot) {
  const count = Array.isArray(robot?.goals) ? robot.goals.length : 0;
  return count > 0 ? `goals/${count - 1}` : "goal";
}

/** The robot with another last goal, in the member that it has; the same robot if nothing changes. */
export function withLastGoal(robot, goal) {
  if (lastGoalOf(robot) === goal) return robot;
  if (!(robot?.goals?.length > 0)) return { ...robot, goal };
  return { ...robot, goals: [...robot.goals.slice(0, -1), goal] };
}

/** The robot without any goal. */
export function withoutGoals(robot) {
  const { goal: _, goals: __, ...rest } = robot;
  return Object.keys(rest).length === Object.keys(robot).length ? robot : rest;
}

/** The goal that the parts of a JSON Pointer below a robot lead to or into; undefined if there is none. */
export function goalAt(robot, [member, index]) {
  if (member === "goal") return robot?.goal;
  return member === "goals" ? (robot?.goals?.[Number(index)] ?? lastGoalOf(robot)) : undefined;
}
