// The dependencies of a plan, see docs/execution.md, that concern one action of a robot. Pure.

import { timeAtShare } from "./profile.js";
import { poseInAction } from "./timeline.js";

/** @import {Action} from "./types.js" */

/**
 * @typedef {{robot: string, action: number, progress: number}} Progress
 * @typedef {{gate: Progress, until: Progress, slack: number}} Dependency
 */

/**
 * The dependencies of a robot's action, each in the order of the plan. First the dependencies whose gate is in the
 * action: it waits for them. Then the dependencies by which others wait for it.
 * @param {Dependency[]} dependencies
 * @param {string} robot
 * @param {number} action its number in the robot's plan
 */
export function dependenciesOfAction(dependencies, robot, action) {
  const isIn = (place) => place.robot === robot && place.action === action;
  const byProgress = (end) => (a, b) => a[end].progress - b[end].progress;
  return {
    waitsFor: dependencies.filter(({ gate }) => isIn(gate)).sort(byProgress("gate")),
    heldFor: dependencies.filter(({ until }) => isIn(until)).sort(byProgress("until")),
  };
}

/** When and where a robot with these actions has made such progress: {x, y, t}; null without that action. */
export function momentOf(actions, { action, progress }) {
  const found = actions[action];
  if (found === undefined) return null;
  const t = timeAtShare(found, progress);
  const { x, y } = poseInAction(found, t);
  return { x, y, t };
}
