// The obstacles of a request that move on their own: people, robots of other fleets. Faulty obstacles are left out.
// Pure. Seconds and metres.

import { obstaclesOf } from "./listed.js";

/** @import {MovingObstacle} from "./types.js" */

/** @returns {MovingObstacle[]} */
export function readObstacles(request) {
  const obstacles = [];
  for (const [index, obstacle] of obstaclesOf(request).entries()) {
    const motion = Array.isArray(obstacle?.motion) ? obstacle.motion : [];
    const isPlaced = motion.every((entry) => [entry?.t, entry?.x, entry?.y].every(Number.isFinite));
    if (motion.length === 0 || !isPlaced || !(obstacle.radius > 0)) continue;
    const id = typeof obstacle.id === "string" ? obstacle.id : `#${index}`;
    obstacles.push({ id, radius: obstacle.radius, motion, stays: obstacle.after === "stays" });
  }
  return obstacles;
}

/** Where an obstacle is at t; null before it appears and after it has left. */
export function obstacleAt({ motion, stays }, t) {
  const next = motion.findIndex((entry) => entry.t >= t);
  if (next < 0) return stays ? place(motion.at(-1)) : null;
  if (motion[next].t === t) return place(motion[next]);
  if (next === 0) return null;
  const [from, to] = [motion[next - 1], motion[next]];
  const share = (t - from.t) / (to.t - from.t);
  return { x: from.x + (to.x - from.x) * share, y: from.y + (to.y - from.y) * share };
}

const place = ({ x, y }) => ({ x, y });
