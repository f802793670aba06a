// Whether vehicles came too close: the positions that they recorded, straight from one to the next.

/** The least distance between the borders of two disks over their tracks of [ms, x, y]. */
export function leastGap(a, b, radii) {
  let least = Infinity;
  const times = [...new Set([...a, ...b].map(([t]) => t))].sort((s, t) => s - t);
  const [pa, pb] = [positions(a, times), positions(b, times)];
  for (let k = 0; k + 1 < times.length; ++k) {
    const from = [pa[k][0] - pb[k][0], pa[k][1] - pb[k][1]];
    const to = [pa[k + 1][0] - pb[k + 1][0], pa[k + 1][1] - pb[k + 1][1]];
    least = Math.min(least, distanceToSegment(from, to) - radii);
  }
  return least;
}

/** The least gap of all pairs. */
export function leastGapOfAll(tracks, radii) {
  let least = Infinity;
  for (let i = 0; i < tracks.length; ++i) {
    for (let j = 0; j < i; ++j) {
      least = Math.min(least, leastGap(tracks[i], tracks[j], radii[i] + radii[j]));
    }
  }
  return least;
}

/** Positions at ascending times; before the first entry and after the last, the vehicle stands. */
function positions(track, times) {
  let k = 0;
  return times.map((t) => {
    while (k + 1 < track.length && track[k + 1][0] <= t) ++k;
    const [t0, x0, y0] = track[k];
    if (t <= t0 || k + 1 === track.length) return [x0, y0];
    const [t1, x1, y1] = track[k + 1];
    const share = (t - t0) / (t1 - t0);
    return [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
  });
}

/** Of the origin. */
function distanceToSegment([x0, y0], [x1, y1]) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const squared = dx * dx + dy * dy;
  const share = squared > 0 ? Math.min(1, Math.max(0, -(x0 * dx + y0 * dy) / squared)) : 0;
  return Math.hypot(x0 + share * dx, y0 + share * dy);
}
