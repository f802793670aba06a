// The moments at which something changes in a plan. Pure.

const SAME = 1e-6; // seconds: actions of two robots that end together are one moment

/** The beginnings and ends of all actions of some tracks, ascending, seconds. */
export function eventTimes(tracks) {
  const times = [];
  for (const { actions } of tracks) for (const { t_start, t_end } of actions) times.push(t_start, t_end);
  times.sort((a, b) => a - b);
  return times.filter((time, at) => at === 0 || time - times[at - 1] > SAME);
}

/** The first of these times after t, or the last before it (direction -1); t itself if there is none. */
export function nextEvent(times, t, direction) {
  const found =
    direction > 0 ? times.find((time) => time > t + SAME) : times.findLast((time) => time < t - SAME);
  return found ?? t;
}
