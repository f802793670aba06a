// How far an action is whose speed changes, and how fast: actions of robots that need time to start and to stop. Pure.
// Seconds, metres or radians.

/** @import {Action, Inertia} from "./types.js" */

const ROUNDING = 1e-6; // seconds

/** What the robot of a request needs to change its speed: seconds to gain, and to lose, a metre (radian) per second. */
export function inertiaOf(robot, defaults = null) {
  const inverse = (name) => {
    const given = robot?.[name] ?? defaults?.[name];
    return Number.isFinite(given) && given > 0 ? 1 / given : 0;
  };
  const rise = inverse("linear_acceleration");
  return { rise, fall: inverse("linear_deceleration") || rise, turn: inverse("angular_acceleration") };
}

/** The inertia of a robot after a goal whose load changes how it drives. `inertia`: before. */
export function inertiaAfter(goal, inertia) {
  const loaded = inertiaOf({
    linear_acceleration: goal?.linear_acceleration_after,
    linear_deceleration: goal?.linear_deceleration_after,
  });
  return { ...inertia, rise: loaded.rise || inertia.rise, fall: loaded.fall || inertia.fall };
}

/**
 * The actions; each action with a profile gets `changes`: the seconds in which its speed rises and falls. A profile
 * that does not fit into its action is left out, as in the service's check. The action is then at constant speed.
 * @param {Action[]} actions
 * @param {Inertia} inertia at first
 * @param {{t: number, inertia: Inertia}[]} later each from its t on
 */
export function withChanges(actions, inertia, later = []) {
  if (!actions.some(({ profile }) => profile)) return actions;
  const inertiaAt = (t) => later.findLast((each) => each.t <= t + ROUNDING)?.inertia ?? inertia;
  return actions.map((action) => {
    const { profile, type } = action;
    if (!profile) return action;
    const turns = type === "rotate";
    const inertia = inertiaAt(action.t_start);
    const rise = (profile.cruise - profile.start) * (turns ? inertia.turn : inertia.rise);
    const fall = (profile.cruise - profile.end) * (turns ? inertia.turn : inertia.fall);
    const lasts = action.t_end - action.t_start;
    const fits = profile.cruise > 0 && rise >= 0 && fall >= 0 && rise + fall <= lasts + ROUNDING;
    return fits ? { ...action, changes: { rise, fall } } : action;
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

/**
 * The share of a way that is covered after a share of its time, while the speed changes evenly. The speed is 1 - ramp
 * of its mean at first, and 1 + ramp at last.
 */
export const coveredShare = (elapsed, ramp) => elapsed * (1 - ramp * (1 - elapsed));

/** The share of the time that it takes to cover a share of the way: the inverse of coveredShare. */
function elapsedShare(covered, ramp) {
  const square = (1 - ramp) ** 2 + 4 * ramp * covered;
  return covered > 0 ? (2 * covered) / (1 - ramp + Math.sqrt(Math.max(0, square))) : 0;
}

/**
 * The parts of an action, one after the other. In each part, the speed changes evenly. A part says from which share of
 * the way to which it leads, and its `ramp`, see coveredShare. The page derives all positions of robots from them.
 * @param {Action} action
 * @returns {{t_start: number, t_end: number, from: number, to: number, ramp: number}[]}
 */
export function phasesOf({ t_start, t_end, profile, changes }) {
  const whole = { t_start, t_end, from: 0, to: 1, ramp: 0 };
  if (!profile || !changes) return [whole];
  const { start, cruise, end } = profile;
  const risen = Math.min(t_end, t_start + changes.rise);
  const falls = Math.max(risen, t_end - changes.fall);
  const parts = [
    { begin: t_start, until: risen, first: start, last: cruise },
    { begin: risen, until: falls, first: cruise, last: cruise },
    { begin: falls, until: t_end, first: cruise, last: end },
  ].filter(({ begin, until, first, last }) => until > begin && first + last > 0);
  const lengths = parts.map(({ begin, until, first, last }) => ((first + last) / 2) * (until - begin));
  const length = lengths.reduce((sum, each) => sum + each, 0);
  if (!(length > 0)) return [whole];
  let covered = 0;
  return parts.map(({ begin, until, first, last }, at) => {
    const from = covered / length;
    covered += lengths[at];
    const to = at + 1 < parts.length ? covered / length : 1;
    return { t_start: begin, t_end: until, from, to, ramp: (last - first) / (last + first) };
  });
}

/** The share of the way, in [0, 1], that an action has covered at t. */
export function shareAt(action, t) {
  const { t_start, t_end } = action;
  if (!(t_end > t_start) || t >= t_end) return 1;
  if (t <= t_start) return 0;
  const phases = phasesOf(action);
  const phase = phases.find((each) => t < each.t_end) ?? phases[phases.length - 1];
  const elapsed = (t - phase.t_start) / (phase.t_end - phase.t_start);
  return phase.from + (phase.to - phase.from) * coveredShare(elapsed, phase.ramp);
}

/** The time at which an action has covered a share of its way: the inverse of shareAt. */
export function timeAtShare(action, share) {
  const phases = phasesOf(action);
  const phase = phases.find(({ to }) => share <= to) ?? phases[phases.length - 1];
  const elapsed = elapsedShare((share - phase.from) / (phase.to - phase.from), phase.ramp);
  return phase.t_start + (phase.t_end - phase.t_start) * elapsed;
}
