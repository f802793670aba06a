// Pointing at world points of the scene with the mouse.

/** Where a world point is in the window, CSS pixels. */
export async function windowPoint(page, point) {
  const box = await page.locator("#scene").boundingBox();
  const { x, y } = await page.evaluate((world) => window.fleetplan.pointOf(world), point);
  return { x: box.x + x, y: box.y + y };
}

/** Clicks at a world point. */
export async function press(page, point) {
  const { x, y } = await windowPoint(page, point);
  await page.mouse.click(x, y);
}

/** Drags with the mouse from one world point to others; `beside`: pixels off the first. */
export async function drag(page, [from, ...others], beside = { x: 0, y: 0 }) {
  const first = await windowPoint(page, from);
  await page.mouse.move(first.x + beside.x, first.y + beside.y);
  await page.mouse.down();
  for (const point of others) {
    const { x, y } = await windowPoint(page, point);
    await page.mouse.move(x, y, { steps: 8 });
  }
  await page.mouse.up();
}
