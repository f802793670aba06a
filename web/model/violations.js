// What a check of a plan (POST /v1/validate) found, in words, and when it can be seen. Pure.

import { Follower } from "./motion.js";

const SEEN = 0.25; // seconds before and after its moment for which a violation can be seen

const CONTACT = 1e-6; // metres that disks may overlap in contact

const KINDS = {
  robot_collision: "Robots collide",
  obstacle_collision: "Collides with a wall",
  discontinuity: "Motion is broken",
  speed: "Faster than the robot can",
  wrong_start: "Does not begin at the start",
  wrong_goal: "Does not end at the goal",
};

/** A kind of violation in words. */
export function kindInWords(kind) {
  return KINDS[kind] ?? kind;
}

/** The violations to be seen at a time: robots that overlap then, and all whose moment is near. */
export function violationsAt(violations, time, motions) {
  return violations.filter(
    ({ kind, robots, t }) =>
      Math.abs(t - time) <= SEEN || (kind === "robot_collision" && overlap(motions, robots, time)),
  );
}

function overlap(motions, ids, time) {
  const [a, b] = ids.map((id) => motions.get(id));
  if (!a || !b) return false;
  const [one, other] = [a, b].map((motion) => {
    const follower = new Follower(motion);
    follower.look(time, time);
    return follower;
  });
  return Math.hypot(other.x - one.x, other.y - one.y) < a.radius + b.radius - CONTACT;
}
