// The map as images, a pixel a cell, made once; drawing it at any zoom is then a matter of a few copies.

const TILE = 2048; // cells a side: canvases of any browser and memory hold that

/** The grid's tiles: [{canvas, column, row, columns, rows}], blocked cells in the wall's colour, free ones clear. */
export function rasterize(grid, wallColour) {
  const wall = rgbaOf(wallColour);
  const tiles = [];
  for (let row = 0; row < grid.rows; row += TILE) {
    for (let column = 0; column < grid.columns; column += TILE) {
      const columns = Math.min(TILE, grid.columns - column);
      const rows = Math.min(TILE, grid.rows - row);
      tiles.push({ canvas: paintTile(grid, column, row, columns, rows, wall), column, row, columns, rows });
    }
  }
  return tiles;
}

/** Draws the tiles; `left`, `top` is the map's upper left corner and `cell` a cell's side, in the context's pixels. */
export function drawTiles(context, tiles, left, top, cell) {
  context.imageSmoothingEnabled = cell < 1;
  context.imageSmoothingQuality = "high";
  const snap = (start, count) => Math.round(start + count * cell);
  for (const { canvas, column, row, columns, rows } of tiles) {
    const x = snap(left, column);
    const y = snap(top, row);
    context.drawImage(canvas, x, y, snap(left, column + columns) - x, snap(top, row + rows) - y);
  }
}

function paintTile(grid, column, row, columns, rows, wall) {
  const canvas = document.createElement("canvas");
  canvas.width = columns;
  canvas.height = rows;
  const context = canvas.getContext("2d");
  const image = context.createImageData(columns, rows);
  const pixels = new Uint32Array(image.data.buffer);
  for (let y = 0; y < rows; y += 1) {
    const first = (row + y) * grid.columns + column;
    for (let x = 0; x < columns; x += 1) {
      if (grid.blocked[first + x]) pixels[y * columns + x] = wall;
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/** A CSS colour as the bytes of a pixel. */
function rgbaOf(colour) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const context = canvas.getContext("2d");
  context.fillStyle = colour;
  context.fillRect(0, 0, 1, 1);
  return new Uint32Array(context.getImageData(0, 0, 1, 1).data.buffer)[0];
}
