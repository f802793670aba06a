// The cells of a map: where they are and which of them a line or a rectangle covers. Pure. A cell is {column, row}; row
// 0 is at the top. It may lie outside the map. A grid: see readScene.

/** The cell that holds a world point. */
export function cellAt({ origin, resolution, rows }, point) {
  const above = Math.floor((point.y - origin.y) / resolution);
  return { column: Math.floor((point.x - origin.x) / resolution), row: rows - 1 - above };
}

/** The middle of a cell, metres, without rounding digits. */
export function centreOf({ origin, resolution, rows }, { column, row }) {
  return {
    x: tidy(origin.x + (column + 0.5) * resolution),
    y: tidy(origin.y + (rows - row - 0.5) * resolution),
  };
}

export function isInside({ columns, rows }, { column, row }) {
  return column >= 0 && column < columns && row >= 0 && row < rows;
}

/** Whether a cell is free; cells outside the map are not. */
export function isFree(grid, cell) {
  return isInside(grid, cell) && grid.blocked[cell.row * grid.columns + cell.column] === 0;
}

/** Every cell of the map that the segment between two world points passes through. */
export function cellsAlong(grid, from, to) {
  const { column, row } = cellAt(grid, from);
  const last = cellAt(grid, to);
  const across = walk(from.x - grid.origin.x, to.x - from.x, grid.resolution);
  const down = walk(from.y - grid.origin.y, to.y - from.y, grid.resolution);
  const cell = { column, row };
  const cells = [];
  const steps = Math.abs(last.column - column) + Math.abs(last.row - row);
  for (let step = 0; ; step += 1) {
    if (isInside(grid, cell)) cells.push({ ...cell });
    if (step === steps) return cells;
    if (cell.row === last.row || (cell.column !== last.column && across.next <= down.next)) {
      cell.column += Math.sign(last.column - column);
      across.next += across.each;
    } else {
      cell.row += Math.sign(last.row - row);
      down.next += down.each;
    }
  }
}

/** The fraction of the segment at which a coordinate next crosses a grid line, and the fraction per cell. */
function walk(start, length, cell) {
  if (length === 0) return { next: Infinity, each: Infinity };
  const into = start / cell - Math.floor(start / cell);
  const each = cell / Math.abs(length);
  return { next: (length > 0 ? 1 - into : into) * each, each };
}

/** Every cell of the map in the rectangle between two cells. */
export function cellsBetween(grid, a, b) {
  const cells = [];
  const last = { column: Math.max(a.column, b.column), row: Math.max(a.row, b.row) };
  for (let row = Math.min(a.row, b.row); row <= last.row; row += 1) {
    for (let column = Math.min(a.column, b.column); column <= last.column; column += 1) {
      if (isInside(grid, { column, row })) cells.push({ column, row });
    }
  }
  return cells;
}

/** The nearest number of 12 digits: 0.3 for 0.30000000000000004. */
export const tidy = (value) => Number(value.toPrecision(12));
