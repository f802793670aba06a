// Which cells of a map are blocked. Large maps are read in pieces before they are drawn, so that the page goes on
// meanwhile.

const [GROUND, GRASS] = [...".G"].map((letter) => letter.charCodeAt(0)); // the letters of free cells
const PIECE = 400_000; // cells that are read in one go

/** @type {WeakMap<string[], Uint8Array>} */
const prepared = new WeakMap(); // by the rows of a map

/** Reads rows of a map of so many columns, from `begin` to before `end`, into `blocked`, see Grid. */
export function readRows(lines, columns, blocked, begin, end) {
  for (let row = begin; row < end; row += 1) {
    const line = lines[row];
    const first = row * columns;
    for (let column = 0; column < columns; column += 1) {
      const letter = line.charCodeAt(column);
      blocked[first + column] = letter === GROUND || letter === GRASS ? 0 : 1;
    }
  }
}

/** Reads the rows of a map in pieces, with `nextTask()` between them. Faulty rows are left to readGrid. */
export async function prepareCells(rows, nextTask) {
  const columns = rows[0]?.length ?? 0;
  if (columns * rows.length <= PIECE || rows.some((row) => typeof row !== "string" || row.length !== columns))
    return;
  const blocked = new Uint8Array(columns * rows.length);
  const step = Math.max(1, Math.floor(PIECE / columns));
  for (let row = 0; row < rows.length; row += step) {
    readRows(rows, columns, blocked, row, Math.min(rows.length, row + step));
    await nextTask();
  }
  prepared.set(rows, blocked);
}

/** What was read of the rows of a map before, or null. */
export function preparedCells(rows) {
  return prepared.get(rows) ?? null;
}
