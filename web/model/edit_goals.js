// Edits of the goals of a robot, in the order of its visits; see edit_request.js and goals.js. Pure. Metres, seconds.

import { objectOf, withMembers } from "./edit_request.js";
import { alternativesOf, goalsOf } from "./goals.js";
import { robotsOf } from "./listed.js";

/** The request with members of one of a robot's goals set, or removed if undefined. */
export function setGoal(request, index, number, members) {
  return withGoals(request, index, (goals) =>
    goals.map((goal, at) => (at === number ? withMembers(objectOf(goal), members) : goal)),
  );
}

/** The request with a goal {x, y} more, which the robot visits last. */
export function appendGoal(request, index, goal) {
  return withGoals(request, index, (goals) => [...goals, goal]);
}

/** The request without one of a robot's goals. */
export function removeGoalAt(request, index, number) {
  return withGoals(request, index, (goals) => goals.filter((_, at) => at !== number));
}

/** The request with a goal visited one place earlier. */
export function advanceGoal(request, index, number) {
  if (number < 1) return request;
  return withGoals(request, index, (goals) => {
    const [before, goal] = [goals[number - 1], goals[number]];
    return [...goals.slice(0, number - 1), goal, before, ...goals.slice(number + 1)];
  });
}

/** The request with a pose more at which one of a robot's goals may be served, besides its own pose or poses. */
export function appendAlternative(request, index, number, pose) {
  return withAlternatives(request, index, number, (poses) => [...poses, pose]);
}

/** The request with members of one of a goal's alternative poses set, or removed if undefined. */
export function setAlternative(request, index, number, at, members) {
  return withAlternatives(request, index, number, (poses) =>
    poses.map((pose, place) => (place === at ? withMembers(objectOf(pose), members) : pose)),
  );
}

/** The request without one of a goal's alternative poses. If there were two, the other pose becomes the goal. */
export function removeAlternative(request, index, number, at) {
  return withAlternatives(request, index, number, (poses) => poses.filter((_, place) => place !== at));
}

/** A goal with one pose has its members, with several `any_of`. */
function withAlternatives(request, index, number, change) {
  return withGoals(request, index, (goals) =>
    goals.map((goal, at) => {
      if (at !== number) return goal;
      const { x, y, theta, any_of: _, choice: ___, ...rest } = objectOf(goal); // its number counts poses
      const listed = alternativesOf(goal);
      const poses = change(listed.length > 0 ? listed : [withMembers({ x, y }, { theta })]);
      if (poses.length > 1) return { any_of: poses, ...rest };
      const { bias: __, ...pose } = objectOf(poses[0]);
      return { ...pose, ...rest };
    }),
  );
}

/** A robot with one goal has `goal`, with several `goals`, as people write them. */
function withGoals(request, index, change) {
  const robots = robotsOf(request).map((robot, at) => {
    if (at !== index) return robot;
    const goals = change(goalsOf(robot));
    const { goal: _, goals: __, ...rest } = objectOf(robot);
    if (goals.length === 0) return rest;
    return goals.length === 1 ? { ...rest, goal: goals[0] } : { ...rest, goals };
  });
  return { ...objectOf(request), robots };
}
