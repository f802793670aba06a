// The camera: between the world (metres, x right, y up) and the screen (CSS pixels, x right, y down). Pure. A
// camera is {x, y, scale}: the world point in the middle of the viewport and pixels per metre. A viewport is
// {width, height}, bounds are {left, bottom, right, top}.

const LARGEST_CELL = 240; // pixels: the limit of zooming in
const SMALLEST_SHARE = 0.5; // of the fitted scale: the limit of zooming out

export function toScreen(camera, viewport, point) {
  return {
    x: viewport.width / 2 + (point.x - camera.x) * camera.scale,
    y: viewport.height / 2 - (point.y - camera.y) * camera.scale,
  };
}

export function toWorld(camera, viewport, pixel) {
  return {
    x: camera.x + (pixel.x - viewport.width / 2) / camera.scale,
    y: camera.y - (pixel.y - viewport.height / 2) / camera.scale,
  };
}

/**
 * The camera that shows all of the bounds in the middle of the viewport less its insets, pixels {left, top,
 * right, bottom} to keep clear.
 */
export function fit(bounds, viewport, insets) {
  const width = Math.max(bounds.right - bounds.left, 1e-9);
  const height = Math.max(bounds.top - bounds.bottom, 1e-9);
  const across = Math.max(viewport.width - insets.left - insets.right, 1);
  const down = Math.max(viewport.height - insets.top - insets.bottom, 1);
  const scale = Math.min(across / width, down / height);
  return {
    x: (bounds.left + bounds.right) / 2 + (insets.right - insets.left) / 2 / scale,
    y: (bounds.bottom + bounds.top) / 2 + (insets.top - insets.bottom) / 2 / scale,
    scale,
  };
}

/** The smallest and largest sensible scale for a map that is `fitted` at a scale, with cells of this size. */
export function scaleLimits(fitted, resolution) {
  return { min: fitted * SMALLEST_SHARE, max: Math.max(LARGEST_CELL / resolution, fitted) };
}

/** Zooms by `factor`; the world point under the pixel stays under it. */
export function zoomAt(camera, viewport, pixel, factor, limits) {
  const scale = Math.min(limits.max, Math.max(limits.min, camera.scale * factor));
  const held = toWorld(camera, viewport, pixel);
  return {
    x: held.x - (pixel.x - viewport.width / 2) / scale,
    y: held.y + (pixel.y - viewport.height / 2) / scale,
    scale,
  };
}

/** Moves the view by dx, dy pixels. */
export function panBy(camera, dx, dy) {
  return { ...camera, x: camera.x - dx / camera.scale, y: camera.y + dy / camera.scale };
}

/** Keeps the middle of the viewport within the bounds, so that the map stays in view. */
export function keepInSight(camera, bounds) {
  return {
    ...camera,
    x: Math.min(bounds.right, Math.max(bounds.left, camera.x)),
    y: Math.min(bounds.top, Math.max(bounds.bottom, camera.y)),
  };
}
