// Figures of several robots side by side. Pure. Seconds and metres.

import { clearanceOf } from "./clearance.js";
import { delayOf } from "./gantt.js";
import { totals } from "./itinerary.js";

/** @import {Motion, Track} from "./types.js" */

/**
 * A row for each robot: {id, cost, delay, moving, turning, waiting, distance}; cost and delay are null if they are not
 * known.
 * @param {string[]} ids
 * @param {Map<string, Track>} tracks
 */
export function compareRobots(ids, tracks) {
  return ids.map((id) => {
    const track = /** @type {Track} */ (tracks.get(id));
    const delay = delayOf(track);
    return { id, cost: track.cost, delay: delay === -Infinity ? null : delay, ...totals(track.actions) };
  });
}

/**
 * When two of these robots are nearest to each other: {t, gap, ids}; null for fewer than two.
 * @param {string[]} ids
 * @param {Map<string, Motion>} motions
 */
export function nearestAmong(ids, motions) {
  const curve = clearanceOf(ids.map((id) => motions.get(id)));
  if (curve === null) return null;
  const { t, gap, first, second, least } = curve;
  return { t: t[least], gap: gap[least], ids: [ids[first[least]], ids[second[least]]] };
}
