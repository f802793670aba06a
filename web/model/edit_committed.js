// Edits of the committed actions of a robot, which it executes whatever is planned; see edit_request.js. Pure.

import { setRobot } from "./edit_request.js";

/** @import {Action} from "./types.js" */

/** The committed actions of a robot of a request; none if they are faulty. */
export const committedOf = (robot) => (Array.isArray(robot?.committed) ? robot.committed : []);

/**
 * The actions of which the first ones can be committed: the actions of the robot's plan, if they begin with the
 * committed actions. Otherwise, only the committed actions.
 * @param {Action[]} planned
 * @returns {Action[]}
 */
export function committable(robot, planned) {
  const committed = committedOf(robot);
  const isBegun = committed.every((action, at) => JSON.stringify(action) === JSON.stringify(planned[at]));
  return isBegun ? [...committed, ...planned.slice(committed.length)] : committed;
}

/** The request with these actions of a robot committed; none if the list is empty. */
export function setCommitted(request, index, actions) {
  return setRobot(request, index, "committed", actions.length > 0 ? actions : undefined);
}

/** The committed actions that a text has as JSON; throws a SyntaxError if it has none. */
export function readCommitted(text) {
  const read = text.trim() === "" ? [] : JSON.parse(text);
  if (!Array.isArray(read)) throw new SyntaxError("it is not a list of actions");
  return read;
}
