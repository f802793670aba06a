// Robots that are stuck: they gain nothing towards their goals within the planning horizon, because others are in their
// way.

/** @import {Answer, Blocked} from "./types.js" */

/**
 * The robots of an answer that are stuck, as entries like the entries of `unplanned`.
 * @param {Answer | null} answer
 * @returns {Blocked[]}
 */
export function stuckOf(answer) {
  const stuck = (answer?.plans ?? []).filter((plan) => plan.stuck === true);
  return stuck.map(({ robot, blocked_by, blocked_by_total }) => ({
    robot,
    reason: "stuck",
    blocked_by,
    blocked_by_total,
  }));
}

/** The ids of the robots that block a robot with this track (see readTracks), which has no plan or is stuck. */
export const blockersOf = (track) => (track?.unplanned ?? track?.stuck)?.blocked_by ?? [];
