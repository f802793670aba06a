// Edits of the moving obstacles of a request, see edit_request.js. They are identified by their index. Pure. Metres,
// seconds.

import { tidy } from "./cells.js";
import { objectOf, unusedId, withMembers } from "./edit_request.js";
import { obstaclesOf, robotsOf } from "./listed.js";

const LASTS = 10; // seconds, of the first motion
const NEXT = 5; // seconds from the last entry to a new one

/** The entries of an obstacle's motion, valid or not. */
export function motionOf(obstacle) {
  return Array.isArray(obstacle?.motion) ? obstacle.motion : [];
}

/** The request with an obstacle more, of a radius, that stands at a point for some time. */
export function addObstacle(request, { x, y }, radius) {
  const motion = [
    { t: 0, x, y },
    { t: LASTS, x, y },
  ];
  const id = unusedId([...obstaclesOf(request), ...robotsOf(request)], "obstacle-");
  return withObstacles(request, [...obstaclesOf(request), { id, radius, motion }]);
}

/** The request with members of an obstacle set, or removed if undefined. */
export function setObstacle(request, index, members) {
  const obstacles = obstaclesOf(request).map((obstacle, at) =>
    at === index ? withMembers(objectOf(obstacle), members) : obstacle,
  );
  return withObstacles(request, obstacles);
}

/** The request with members {t, x, y} of an entry of an obstacle's motion set. */
export function setEntry(request, index, number, members) {
  const motion = motionOf(obstaclesOf(request)[index]).map((entry, at) =>
    at === number ? withMembers(objectOf(entry), members) : entry,
  );
  return setObstacle(request, index, { motion });
}

/** The request with an entry more at the end of an obstacle's motion, where it is then. */
export function appendEntry(request, index) {
  const motion = motionOf(obstaclesOf(request)[index]);
  const { t = -NEXT, x = 0, y = 0 } = objectOf(motion.at(-1));
  return setObstacle(request, index, { motion: [...motion, { t: tidy(t + NEXT), x, y }] });
}

/** The request without an entry of an obstacle's motion, which keeps one. */
export function removeEntry(request, index, number) {
  const motion = motionOf(obstaclesOf(request)[index]);
  if (motion.length < 2) return request;
  return setObstacle(request, index, { motion: motion.filter((_, at) => at !== number) });
}

export function deleteObstacle(request, index) {
  return withObstacles(
    request,
    obstaclesOf(request).filter((_, at) => at !== index),
  );
}

function withObstacles(request, obstacles) {
  return withMembers(objectOf(request), { obstacles: obstacles.length > 0 ? obstacles : undefined });
}
