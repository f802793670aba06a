// Dependencies of an action, in words and as arrows in the scene and in the timeline.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, planAndPause, seek } from "../support/browser.js";
import { countColour, hasTime, pagesFor, themeColour } from "../support/on_page.js";

const onPage = pagesFor();

test("what an action waits for is listed, and drawn in scene and timeline", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "hospital-ward");
    const answer = await planAndPause(page);
    const { dependencies } = await page.evaluate(
      async (body) => {
        const headers = { "Content-Type": "application/json" };
        return (await fetch("v1/dependencies", { method: "POST", headers, body })).json();
      },
      JSON.stringify({ ...request, ...answer }),
    );
    const { gate, until } = dependencies.find(({ gate }) => gate.progress > 0.1);
    const { actions } = answer.plans.find(({ robot }) => robot === gate.robot);
    const action = actions[gate.action];
    await page.click(`.robot[data-robot="${gate.robot}"]`);
    await seek(page, (action.t_start + action.t_end) / 2);
    await hasTime(page, (action.t_start + action.t_end) / 2);
    await page.click("#inspector .close");
    await page.click(`.robot[data-robot="${gate.robot}"]`);
    await page.focus("#tab-plan");
    await page.keyboard.press("End");
    await page.getByText("Dependencies", { exact: true }).click();

    const place = await page.evaluate((point) => window.fleetplan.pointOf(point), placeOf(actions, gate));
    const danger = await themeColour(page, "--scene-danger");
    const before = await countColour(page, danger, place, 12);
    const barsBefore = await timelineColour(page, danger);
    await page.getByRole("button", { name: "Show dependencies" }).focus();
    await page.keyboard.press("Enter");
    await page.getByText(`dependencies in the plan`).waitFor();
    const words = await page.innerText("#panel-analyse");
    assert.ok(words.includes(`${gate.robot}, action ${gate.action}: `), words);
    assert.ok(words.includes(until.robot), words);
    assert.ok((await countColour(page, danger, place, 12)) > before + 5, "an arrow ends at the gate");
    assert.ok((await timelineColour(page, danger)) > barsBefore, "and one is in the timeline");
    await seek(page, answer.makespan);
    await page.getByText("Select a moving robot.").waitFor();
    assert.equal(await countColour(page, danger, place, 12), before);
  });
});

function placeOf(actions, { action, progress }) {
  const { from, to } = actions[action];
  return { x: from.x + (to.x - from.x) * progress, y: from.y + (to.y - from.y) * progress };
}

/** How many pixels of the timeline have about a colour, "r,g,b". */
function timelineColour(page, colour) {
  return page.evaluate((wanted) => {
    const canvas = document.getElementById("timeline-canvas");
    const copy = new OffscreenCanvas(canvas.width, canvas.height);
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const [red, green, blue] = wanted.split(",").map(Number);
    let found = 0;
    for (let at = 0; at < data.length; at += 4) {
      const apart = Math.abs(data[at] - red) + Math.abs(data[at + 1] - green) + Math.abs(data[at + 2] - blue);
      if (data[at + 3] > 150 && apart < 40) found += 1;
    }
    return found;
  }, colour);
}
