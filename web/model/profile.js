// How far an action is whose speed changes, and how fast: actions of robots that need time to start and to stop. Pure.
// Seconds, metres or radians.

/** @import {Action, Inertia} from "./types.js" */

/** What the robot of a request needs to change its speed: seconds to gain, and to lose, a metre (radian) per second. */
export function inertiaOf(robot, defaults = null) {
  const inverse = (name) => {
    const given = robot?.[name] ?? defaults?.[name];
    return Number.isFinite(given) && given > 0 ? 1 / given : 0;
  };
  const rise = inverse("linear_acceleration");
  return { rise, fall: inverse("linear_deceleration") || rise, turn: inverse("angular_acceleration") };
}

/** That of a robot, which had another one, after a goal whose load changes how it drives. */
export function inertiaAfter(goal, inertia) {
  const loaded = inertiaOf({
    linear_acceleration: goal?.linear_acceleration_after,
    linear_deceleration: goal?.linear_deceleration_after,
  });
  return { ...inertia, rise: loaded.rise || inertia.rise, fall: loaded.fall || inertia.fall };
}

/**
 * The actions, each that has a profile with `changes`: the seconds in which its speed rises and falls.
 * @param {Action[]} actions
 * @param {Inertia} inertia at first
 * @param {{t: number, inertia: Inertia}[]} later each from its t on
 */
export function withChanges(actions, inertia, later = []) {
  if (!actions.some(({ profile }) => profile)) return actions;
  const rounding = 1e-6; // seconds
  const inertiaAt = (t) => later.findLast((each) => each.t <= t + rounding)?.inertia ?? inertia;
  return actions.map((action) => {
    const { profile, type } = action;
    if (!profile) return action;
    const turns = type === "rotate";
    const inertia = inertiaAt(action.t_start);
    const rise = (profile.cruise - profile.start) * (turns ? inertia.turn : inertia.rise);
    const fall = (profile.cruise - profile.end) * (turns ? inertia.turn : inertia.fall);
    return { ...action, changes: { rise, fall } };
  });
}

/** The speed at t of an action with a profile; the mean speed of `amount` (metres or radians) without one. */
export function speedAt(action, t, amount) {
  const { t_start, t_end, profile, changes } = action;
  if (!changes) return t_end > t_start ? amount / (t_end - t_start) : 0;
  const before = Math.max(0, t - t_start);
  const left = Math.max(0, t_end - t);
  if (before < changes.rise)
    return profile.start + ((profile.cruise - profile.start) * before) / changes.rise;
  if (left < changes.fall) return profile.end + ((profile.cruise - profile.end) * left) / changes.fall;
  return profile.cruise;
}

/** The share of the way, in [0, 1], that an action has covered at t. */
export function shareAt(action, t) {
  const { t_start, t_end, changes } = action;
  const duration = t_end - t_start;
  if (!(duration > 0)) return 1;
  const elapsed = Math.min(duration, Math.max(0, t - t_start));
  if (!changes || elapsed === duration) return elapsed / duration;
  return covered(action, elapsed) / covered(action, duration);
}

/** The time at which an action has covered a share of its way: the inverse of shareAt. */
export function timeAtShare(action, share) {
  const { t_start, t_end, changes } = action;
  if (!changes) return t_start + (t_end - t_start) * share;
  let [early, late] = [t_start, t_end];
  for (let halving = 0; halving < 40; halving += 1) {
    const middle = (early + late) / 2;
    if (shareAt(action, middle) < share) early = middle;
    else late = middle;
  }
  return late;
}

/** The times within an action between which it covers its way evenly, up to a small part of its way. */
export function knotsOf(action) {
  const { t_start, t_end, changes } = action;
  if (!changes) return [t_start, t_end];
  const pieces = 16; // chords: a change from 0 to 1.5 m/s within 1.5 s is less than 1.2 mm away
  const times = [t_start];
  for (let piece = 1; piece <= pieces; piece += 1) times.push(t_start + (changes.rise * piece) / pieces);
  for (let piece = 0; piece <= pieces; piece += 1) times.push(t_end - changes.fall * (1 - piece / pieces));
  return [...new Set(times)].sort((a, b) => a - b);
}

/** What the profile covers in its first seconds. */
function covered({ t_start, t_end, profile, changes: { rise, fall } }, elapsed) {
  const { start, cruise, end } = profile;
  const rising = Math.min(elapsed, rise);
  const falling = Math.max(0, elapsed - (t_end - t_start - fall));
  const gained = rise > 0 ? ((cruise - start) * rising ** 2) / (2 * rise) : 0;
  const lost = fall > 0 ? ((cruise - end) * falling ** 2) / (2 * fall) : 0;
  return start * rising + gained + cruise * (elapsed - rising) - lost;
}
