// Where robots wait, and where they pass: figures by squares of the map. Pure. Metres and seconds.

const MAX_SQUARES = 180; // along the longer side of the map

/**
 * The heat of a plan on a map: {columns, rows, size, values, most}, the top row first. For "waiting", `values` are the
 * seconds that robots wait in a square; services do not count. For "passage", they are the numbers of robots that pass
 * it.
 * @param {import("./types.js").Grid} grid
 * @param {Iterable<import("./types.js").Track>} tracks
 * @param {"waiting" | "passage"} kind
 */
export function heatOf(grid, tracks, kind) {
  const { bounds, resolution } = grid;
  const longest = Math.max(bounds.right - bounds.left, bounds.top - bounds.bottom);
  const size = Math.max(resolution, longest / MAX_SQUARES);
  const columns = Math.ceil((bounds.right - bounds.left) / size - 1e-9);
  const rows = Math.ceil((bounds.top - bounds.bottom) / size - 1e-9);
  const values = new Float64Array(columns * rows);
  const squareAt = ({ x, y }) => {
    const column = Math.floor((x - bounds.left) / size);
    const row = Math.floor((bounds.top - y) / size);
    return column >= 0 && column < columns && row >= 0 && row < rows ? row * columns + column : -1;
  };
  for (const { actions } of tracks) {
    if (kind === "waiting") addWaits(values, actions, squareAt);
    else for (const square of passed(actions, squareAt, size)) values[square] += 1;
  }
  return { columns, rows, size, values, most: values.reduce((most, value) => Math.max(most, value), 0) };
}

function addWaits(values, actions, squareAt) {
  for (const { type, t_start, t_end, from, goal } of actions) {
    if (type !== "wait" || Number.isInteger(goal)) continue;
    const square = squareAt(from);
    if (square >= 0) values[square] += t_end - t_start;
  }
}

/** The squares that a robot passes, each once. */
function passed(actions, squareAt, size) {
  const squares = new Set();
  for (const { type, from, to } of actions) {
    if (type !== "translate") continue;
    const steps = Math.ceil((2 * Math.hypot(to.x - from.x, to.y - from.y)) / size);
    for (let step = 0; step <= steps; step += 1) {
      const share = steps === 0 ? 0 : step / steps;
      squares.add(squareAt({ x: from.x + (to.x - from.x) * share, y: from.y + (to.y - from.y) * share }));
    }
  }
  squares.delete(-1);
  return squares;
}
