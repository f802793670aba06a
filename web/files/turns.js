// Maps and masks that are turned: the yaw of their origin, about their lower-left corner. Metres, radians.

const QUARTER = Math.PI / 2;
const TOLERANCE = 1e-4; // as in the service

/** The quarter turns of a yaw, 0 to 3, or null if it is not near to a whole number of them. */
export function quarterTurnsOf(yaw) {
  const turns = Math.round(yaw / QUARTER);
  if (!(Math.abs(yaw - turns * QUARTER) <= TOLERANCE)) return null;
  return ((turns % 4) + 4) % 4;
}

/**
 * Turns a raster {columns, rows, cells}, row by row from the top, of a resolution, about its lower-left corner at
 * `corner`. Returns {columns, rows, cells, origin}. `origin` is the lower-left corner of the whole.
 */
export function turned({ columns, rows, cells }, resolution, corner, quarterTurns) {
  const isAcross = quarterTurns % 2 === 1;
  const [width, height] = [columns * resolution, rows * resolution];
  const origin = {
    x: corner.x - [0, height, width, 0][quarterTurns],
    y: corner.y - [0, 0, height, width][quarterTurns],
  };
  if (quarterTurns === 0) return { columns, rows, cells, origin };
  const size = isAcross ? { columns: rows, rows: columns } : { columns, rows };
  const made = new Uint8Array(cells.length);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const [x, y] = turnedCell(column, rows - 1 - row, columns, rows, quarterTurns);
      made[(size.rows - 1 - y) * size.columns + x] = cells[row * columns + column];
    }
  }
  return { ...size, cells: made, origin };
}

/** Rows count from the bottom. */
function turnedCell(column, row, columns, rows, quarterTurns) {
  if (quarterTurns === 1) return [rows - 1 - row, column];
  if (quarterTurns === 2) return [columns - 1 - column, rows - 1 - row];
  return [row, columns - 1 - column];
}
