// Editing a request by mouse, finger, keys and form.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, chosenExample, pause, planAndPause, pressPlan, seek } from "../support/browser.js";
import { coloursAt, countColour, hook, pagesFor, paste, REFUSED, themeColour } from "../support/on_page.js";
import { drag, press, windowPoint } from "../support/scene_pointer.js";

const onPage = pagesFor();

const ROBOT = { radius: 0.3, linear_speed: 1, angular_speed: 1 };
const REQUEST = {
  map: { rows: Array(6).fill(".".repeat(10)) },
  robots: [
    { id: "robot-1", ...ROBOT, start: { x: 0.5, y: 0.5 }, goal: { x: 8.5, y: 0.5, theta: 0 } },
    { id: "robot-2", ...ROBOT, start: { x: 0.5, y: 4.5 }, goal: { x: 8.5, y: 4.5 } },
  ],
};
const PHONE = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };
const QUARTER = Math.PI / 2;

/** A page with a request, on the Edit tab. */
async function editing(page, request = REQUEST) {
  const text = typeof request === "string" ? request : JSON.stringify(request);
  await paste(page, text);
  await isRequest(page, text);
  await page.click("#tab-edit");
}

const isRequest = (page, text) =>
  page.waitForFunction((json) => JSON.stringify(window.fleetplan.request) === json, text);

const robotAt = async (page, index) => (await hook(page, "request")).robots[index];
const rowsOf = async (page) => (await hook(page, "request")).map.rows;
const tool = (page, name) => page.click(`.tool:has([value=${name}])`);
const isAnnounced = (page, words) =>
  page.waitForFunction((part) => document.getElementById("announcer").textContent.includes(part), words);

/** Takes the handle of a pose to a world point. `theta`: where the handle is now. */
async function turn(page, pose, theta, to) {
  const middle = await windowPoint(page, pose);
  const rim = await windowPoint(page, { ...pose, x: pose.x + ROBOT.radius });
  const length = rim.x - middle.x + 22;
  await drag(page, [pose, to], { x: Math.cos(theta) * length, y: -Math.sin(theta) * length });
}

async function undoAll(page) {
  await page.locator("#scene").focus();
  while (await page.isEnabled("#undo")) await page.keyboard.press("Control+z");
}

async function redoAll(page) {
  while (await page.isEnabled("#redo")) await page.keyboard.press("Control+Shift+z");
}

test("walls are drawn and erased with the mouse, one undo step per stroke", async () => {
  await onPage(async (page) => {
    await editing(page);
    await tool(page, "wall");
    await drag(page, [
      { x: 2.5, y: 5.5 },
      { x: 2.5, y: 2.5 },
      { x: 4.5, y: 2.5 },
    ]);
    const walled = ["..#.......", "..#.......", "..#.......", "..###.....", "..........", ".........."];
    assert.deepEqual(await rowsOf(page), walled);
    await press(page, { x: 9.5, y: 5.5 });
    assert.equal((await rowsOf(page))[0], "..#......#");
    await tool(page, "erase");
    await drag(page, [
      { x: 2.5, y: 4.5 },
      { x: 2.5, y: 3.5 },
    ]);
    const erased = ["..#......#", "..........", "..........", "..###.....", "..........", ".........."];
    assert.deepEqual(await rowsOf(page), erased);
    await page.click("#undo");
    await page.click("#undo");
    assert.deepEqual(await rowsOf(page), walled);
    await page.click("#undo");
    assert.deepEqual(await hook(page, "request"), REQUEST);
    assert.equal(await page.isEnabled("#undo"), false);
    await redoAll(page);
    assert.deepEqual(await rowsOf(page), erased);
  });
});

test("drawn walls are painted until they are undone", async () => {
  await onPage(async (page) => {
    await editing(page);
    const [wall, floor] = await Promise.all(
      ["wall", "floor"].map((name) => themeColour(page, `--scene-${name}`)),
    );
    const painted = async () => {
      await tool(page, "select"); // no cursor of cells is in the way
      const at = [2.8, 7.8].map((x) => ({ x, y: 4.2 }));
      return coloursAt(
        page,
        await page.evaluate((all) => all.map((each) => window.fleetplan.pointOf(each)), at),
      );
    };
    const draw = async (x) => {
      await tool(page, "wall");
      await press(page, { x, y: 4.5 });
    };
    assert.deepEqual(await painted(), [floor, floor]);
    await draw(2.5);
    assert.deepEqual(await painted(), [wall, floor]);
    await draw(7.5);
    assert.deepEqual(await painted(), [wall, wall]);
    await page.click("#undo");
    assert.deepEqual(await painted(), [wall, floor]);
  });
});

test("a box of walls is filled with the mouse, and freed with alt", async () => {
  await onPage(async (page) => {
    await editing(page);
    await tool(page, "box");
    await drag(page, [
      { x: 6.5, y: 3.5 },
      { x: 3.5, y: 2.5 },
    ]);
    assert.deepEqual((await rowsOf(page)).slice(2, 4), ["...####...", "...####..."]);
    await page.keyboard.down("Alt");
    await drag(page, [
      { x: 4.5, y: 2.5 },
      { x: 5.5, y: 3.5 },
    ]);
    await page.keyboard.up("Alt");
    assert.deepEqual((await rowsOf(page)).slice(2, 4), ["...#..#...", "...#..#..."]);
  });
});

test("outside the Edit tab, a drag moves the view", async () => {
  await onPage(async (page) => {
    await editing(page);
    await tool(page, "wall");
    await page.click("#tab-plan");
    const before = await windowPoint(page, { x: 0, y: 0 });
    await drag(page, [
      { x: 2.5, y: 5.5 },
      { x: 2.5, y: 2.5 },
    ]);
    assert.deepEqual(await hook(page, "request"), REQUEST);
    assert.notDeepEqual(await windowPoint(page, { x: 0, y: 0 }), before);
    await page.click("#tab-edit");
    await page.keyboard.press("f");
    const { x, y } = await windowPoint(page, { x: 4.5, y: 2.5 });
    await page.mouse.move(x, y);
    await page.mouse.down({ button: "middle" });
    await page.mouse.move(x + 60, y, { steps: 4 });
    await page.mouse.up({ button: "middle" });
    assert.deepEqual(await hook(page, "request"), REQUEST);
    assert.ok(
      Math.abs((await windowPoint(page, { x: 4.5, y: 2.5 })).x - x - 60) < 12,
      "the middle button too",
    );
  });
});

test("robots and goals are dragged and turned with the mouse, one undo step each", async () => {
  await onPage(async (page) => {
    await editing(page);
    await drag(page, [
      { x: 0.6, y: 0.4 },
      { x: 2.7, y: 2.3 },
    ]);
    const expected = structuredClone(REQUEST);
    const [first] = expected.robots;
    first.start = { x: 2.5, y: 2.5 };
    assert.deepEqual(await hook(page, "request"), expected);
    assert.equal(await hook(page, "selected"), "robot-1");
    await isAnnounced(page, "robot-1 starts at (2.5, 2.5) m");
    await drag(page, [
      { x: 8.5, y: 0.5 },
      { x: 6.5, y: 3.5 },
    ]);
    first.goal = { x: 6.5, y: 3.5, theta: 0 };
    assert.deepEqual(await hook(page, "request"), expected);
    await turn(page, first.start, 0, { x: 2.6, y: 5 });
    first.start.theta = QUARTER;
    assert.deepEqual(await hook(page, "request"), expected);
    await turn(page, first.goal, 0, { x: 4, y: 3.45 });
    first.goal.theta = Math.PI;
    assert.deepEqual(await hook(page, "request"), expected);
    await undoAll(page);
    assert.deepEqual(await hook(page, "request"), REQUEST);
    await redoAll(page);
    assert.deepEqual(await hook(page, "request"), expected);
  });
});

test("Alt drags without snapping, Shift drags a goal out of a robot", async () => {
  await onPage(async (page) => {
    const [first, second] = REQUEST.robots;
    await editing(page, { ...REQUEST, robots: [first, { ...second, goal: undefined }] });
    await page.keyboard.down("Alt");
    await drag(page, [
      { x: 0.5, y: 0.5 },
      { x: 2.72, y: 2.31 },
    ]);
    await page.keyboard.up("Alt");
    const { start } = await robotAt(page, 0);
    assert.ok(Math.hypot(start.x - 2.72, start.y - 2.31) < 0.05, JSON.stringify(start));
    await page.keyboard.down("Shift");
    await drag(page, [
      { x: 0.5, y: 4.5 },
      { x: 5.4, y: 4.6 },
    ]);
    await page.keyboard.up("Shift");
    assert.deepEqual((await robotAt(page, 1)).goal, { x: 5.5, y: 4.5 });
    assert.deepEqual((await robotAt(page, 1)).start, second.start);
  });
});

test("robots are added with the mouse, duplicated and deleted", async () => {
  await onPage(async (page) => {
    await editing(page);
    await tool(page, "robot");
    await press(page, { x: 4.4, y: 1.6 });
    await press(page, { x: 6.6, y: 2.6 });
    const added = { id: "robot-3", ...ROBOT, start: { x: 4.5, y: 1.5 }, goal: { x: 6.5, y: 2.5 } };
    assert.deepEqual(await robotAt(page, 2), added);
    await press(page, { x: 4.5, y: 4.5 });
    assert.deepEqual(await robotAt(page, 3), { id: "robot-4", ...ROBOT, start: { x: 4.5, y: 4.5 } });
    assert.equal(await page.inputValue("#robot-id"), "robot-4");
    await page.selectOption("#edited-robot", "2");
    await page.click("#duplicate-robot");
    const copy = await robotAt(page, 4);
    assert.equal(copy.id, "robot-5");
    assert.equal(Math.hypot(copy.start.x - 4.5, copy.start.y - 1.5), 1);
    assert.equal(Math.hypot(copy.goal.x - 6.5, copy.goal.y - 2.5), 1);
    assert.equal(await hook(page, "selected"), "robot-5");
    await page.click("#delete-robot");
    assert.equal((await hook(page, "request")).robots.length, 4);
    assert.equal(await hook(page, "selected"), null);
    await page.keyboard.press("p"); // in the list of robots, where letters choose
    assert.equal(await hook(page, "answer"), null);
    await page.locator("#scene").focus();
    await page.keyboard.press("p");
    await page.waitForFunction(() => window.fleetplan.answer?.status === "solved");
    await pause(page);
    await undoAll(page);
    assert.deepEqual(await hook(page, "request"), REQUEST);
    assert.equal(await hook(page, "answer"), null, "it was not planned");
  });
});

test("the selected robot is moved, turned, duplicated and deleted by keys", async () => {
  await onPage(async (page) => {
    await editing(page);
    await page.selectOption("#edited-robot", "0");
    await page.locator("#tab-edit").focus();
    await page.keyboard.press("v");
    const moves = ["ArrowRight", "ArrowRight", "ArrowUp", "Shift+ArrowUp", "Alt+ArrowRight"];
    for (const key of [...moves, "t", "t", "Shift+G"]) await page.keyboard.press(key);
    const [first] = structuredClone(REQUEST.robots);
    first.start = { x: 2.6, y: 1.5, theta: Math.PI / 6 };
    first.goal = { x: 8.5, y: 1.5, theta: -Math.PI / 12 };
    assert.deepEqual(await robotAt(page, 0), first);
    await isAnnounced(page, "robot-1 has its goal at (8.5, 1.5) m, facing -15°");
    await page.keyboard.press("Control+d");
    assert.equal((await robotAt(page, 2)).id, "robot-3");
    assert.equal(await hook(page, "selected"), "robot-3");
    await page.keyboard.press("Delete");
    assert.equal((await hook(page, "request")).robots.length, 2);
    await undoAll(page);
    assert.deepEqual(await hook(page, "request"), REQUEST);
  });
});

test("walls are drawn by keys, freehand and as a box, and robots added", async () => {
  await onPage(async (page) => {
    await editing(page);
    await page.keyboard.press("w");
    for (let step = 0; step < 12; step += 1) await page.keyboard.press("ArrowLeft");
    for (let step = 0; step < 8; step += 1) await page.keyboard.press("ArrowDown");
    for (const key of ["ArrowRight", "ArrowRight", "Space", "Shift+ArrowUp", "ArrowUp", "Enter"]) {
      await page.keyboard.press(key);
    }
    assert.deepEqual((await rowsOf(page)).slice(3), ["..#.......", "..#.......", "..#......."]);
    await isAnnounced(page, "Column 3, row 4 from the top: wall.");
    await page.keyboard.press("e");
    for (let step = 0; step < 12; step += 1) await page.keyboard.press("ArrowLeft");
    for (let step = 0; step < 8; step += 1) await page.keyboard.press("ArrowDown");
    for (const key of ["ArrowRight", "ArrowRight", "Enter"]) await page.keyboard.press(key);
    assert.equal((await rowsOf(page))[5], "..........");
    await page.keyboard.press("b");
    for (let step = 0; step < 12; step += 1) await page.keyboard.press("ArrowRight");
    for (let step = 0; step < 8; step += 1) await page.keyboard.press("ArrowUp");
    for (const key of ["Enter", "ArrowLeft", "ArrowDown", "Enter"]) await page.keyboard.press(key);
    assert.deepEqual((await rowsOf(page)).slice(0, 3), ["........##", "........##", ".........."]);
    await page.keyboard.press("a");
    for (let step = 0; step < 12; step += 1) await page.keyboard.press("ArrowLeft");
    for (let step = 0; step < 8; step += 1) await page.keyboard.press("ArrowUp");
    await page.keyboard.press("Enter");
    assert.deepEqual((await robotAt(page, 2)).start, { x: 0.5, y: 5.5 });
    assert.equal(await hook(page, "playing"), false);
  });
});

test("the form edits a robot, and typing a value is one undo step", async () => {
  await onPage(async (page) => {
    await editing(page, { ...REQUEST, robot_defaults: { radius: 0.25 } });
    await press(page, { x: 0.5, y: 4.5 });
    const field = (pointer) => page.locator(`[data-pointer="/robots/1/${pointer}"]`);
    assert.equal(await field("radius").getAttribute("placeholder"), "0.25");
    await field("radius").fill("");
    await field("id").fill("carrier");
    await field("linear_speed").fill("1.5");
    await field("start/x").fill("1.25");
    await field("start/theta").fill("90");
    await field("goal/theta").fill("-45");
    const start = { x: 1.25, y: 4.5, theta: QUARTER };
    const changed = { id: "carrier", linear_speed: 1.5, angular_speed: 1, start };
    assert.deepEqual(await robotAt(page, 1), { ...changed, goal: { x: 8.5, y: 4.5, theta: -Math.PI / 4 } });
    assert.equal(await hook(page, "selected"), "carrier");
    assert.match(await page.innerText("#robot-start"), /= 1\.5708 rad/);
    await field("goal/theta").fill("");
    assert.deepEqual((await robotAt(page, 1)).goal, { x: 8.5, y: 4.5 });
    await page.uncheck("#robot-has-goal");
    assert.deepEqual(await robotAt(page, 1), changed);
    await page.check("#robot-has-goal");
    const { goal } = await robotAt(page, 1);
    assert.ok(Math.hypot(goal.x - 1.25, goal.y - 4.5) > 0.5, "beside the start");
    await undoAll(page);
    await field("angular_speed").selectText(); // what is typed takes its place: the field is never empty
    await field("angular_speed").pressSequentially("2.75");
    assert.equal((await robotAt(page, 1)).angular_speed, 2.75);
    await page.click("#undo");
    assert.equal((await robotAt(page, 1)).angular_speed, 1);
  });
});

test("non-numeric input is rejected with a message", async () => {
  await onPage(async (page) => {
    await editing(page);
    await press(page, { x: 0.5, y: 4.5 });
    const field = page.locator('[data-pointer="/robots/1/start/x"]');
    await field.fill("");
    assert.match(await page.innerText("#robot-start"), /Enter a number/);
    assert.deepEqual(await hook(page, "request"), REQUEST);
    await page.mouse.move(400, 300);
    await page.mouse.move(500, 300);
    assert.equal(await field.inputValue(), "");
    await field.fill("3");
    assert.doesNotMatch(await page.innerText("#robot-start"), /Enter a number/);
    assert.equal((await robotAt(page, 1)).start.x, 3);
  });
});

test("a fault is shown at the robot's field and in the scene until it is repaired", async () => {
  await onPage(
    async (page) => {
      await editing(page, { ...REQUEST, map: { rows: [...REQUEST.map.rows.slice(1), "....##...."] } });
      await press(page, { x: 0.5, y: 4.5 });
      const danger = await themeColour(page, "--scene-danger");
      const marks = async (point) => {
        const place = await page.evaluate((world) => window.fleetplan.pointOf(world), point);
        return countColour(page, danger, place, 60);
      };
      await page.fill('[data-pointer="/robots/1/radius"]', "-1");
      await page.waitForSelector('[data-pointer="/robots/1/radius"][aria-invalid=true]');
      assert.match(await page.innerText("#robot-numbers"), /radius must be/);
      assert.ok((await marks({ x: 0.5, y: 4.5 })) > 20);
      assert.match(await page.innerText("#edited-robot option:checked"), /⚠ robot-2/);
      await page.fill('[data-pointer="/robots/1/radius"]', "0.3");
      await page.waitForSelector("#panel-edit [aria-invalid]", { state: "detached" });
      assert.equal(await page.isVisible("#problem"), false);
      assert.equal(await marks({ x: 0.5, y: 4.5 }), 0);
      await drag(page, [
        { x: 0.5, y: 0.5 },
        { x: 4.5, y: 0.5 },
      ]);
      await page.waitForSelector("#robot-start[aria-invalid=true]");
      const message = await page.innerText("#robot-start .field-error");
      assert.match(message, /does not fit at its start: it needs 0\.3 m more than is free/);
      assert.ok((await marks({ x: 4.5, y: 0.5 })) > 20);
      await drag(page, [
        { x: 4.5, y: 0.5 },
        { x: 6.5, y: 2.5 },
      ]);
      await page.waitForSelector("#robot-start[aria-invalid]", { state: "detached" });
      assert.equal(await page.isVisible("#problem"), false);
      assert.equal((await pressPlan(page)).status, "solved");
    },
    { allowed: REFUSED },
  );
});

test("a robot that cannot be drawn can be selected and repaired", async () => {
  await onPage(
    async (page) => {
      const [first, second] = REQUEST.robots;
      await editing(page, { ...REQUEST, robots: [first, { ...second, start: { x: "left", y: 4.5 } }, 7] });
      await page.click("#plan");
      await page.click('[data-error="/robots/1/start/x"]');
      const field = page.locator('[data-pointer="/robots/1/start/x"]');
      assert.equal(await field.evaluate((input) => input === document.activeElement), true);
      assert.equal(await field.getAttribute("placeholder"), '"left"');
      await field.fill("0.5");
      assert.equal(await hook(page, "selected"), "robot-2");
      await page.selectOption("#edited-robot", { label: "⚠ #2" });
      await page.click("#delete-robot");
      assert.deepEqual(await hook(page, "request"), REQUEST);
      await page.waitForSelector("#problem", { state: "hidden" });
    },
    { allowed: REFUSED },
  );
});

test("the map is enlarged and cut on each side and robots keep their positions", async () => {
  await onPage(async (page) => {
    await editing(page);
    await page.click("summary:text-is('Map')");
    const side = (name) => page.click(`[data-side="${name}"]`);
    for (const name of ["left 1", "bottom 1", "bottom 1", "top -1", "right 1"]) await side(name);
    const { map, robots } = await hook(page, "request");
    assert.deepEqual(map, { rows: Array(7).fill(".".repeat(12)), origin: { x: -1, y: -2 } });
    assert.deepEqual(robots, REQUEST.robots);
    await page.locator("#map-numbers input").first().fill("4");
    assert.equal((await rowsOf(page))[0].length, 12, "half a number cuts nothing");
    await page.keyboard.press("Enter");
    assert.equal((await rowsOf(page))[0].length, 4);
    await page.fill('[data-pointer="/map/resolution"]', "0.5");
    await page.keyboard.press("Enter");
    assert.equal((await hook(page, "request")).map.resolution, 0.5);
    await page.locator("#map-numbers input").first().fill("0");
    await page.keyboard.press("Enter");
    assert.match(await page.innerText("#map-numbers"), /at least one cell/);
    await undoAll(page);
    assert.deepEqual(await hook(page, "request"), REQUEST);
  });
});

test("a request is made from scratch: a new map, walls, robots, a plan", async () => {
  await onPage(
    async (page) => {
      await page.click("#tab-edit");
      await page.click("summary:text-is('New map…')");
      await page.fill("#new-columns", "0");
      await page.click("#new-map button");
      assert.match(await page.innerText("#new-map-fault"), /at least one cell/);
      await page.fill("#new-columns", "8");
      await page.fill("#new-rows", "5");
      await page.click("#new-map button");
      const rows = ["########", "#......#", "#......#", "#......#", "########"];
      const robot_defaults = { radius: 0.2, linear_speed: 1, angular_speed: 3.1416 };
      await isRequest(page, JSON.stringify({ map: { rows, resolution: 0.5 }, robot_defaults, robots: [] }));
      await page.waitForSelector(".tool:has([value=wall]:checked)");
      const judged = page.waitForResponse(/validate/);
      await press(page, { x: 1.75, y: 1.25 });
      assert.equal((await judged).status(), 422);
      assert.equal(await page.isVisible("#problem"), false, "that robots are yet to come is no fault");
      await tool(page, "robot");
      await press(page, { x: 0.75, y: 1.25 });
      await press(page, { x: 3.25, y: 1.25 });
      const [robot] = (await hook(page, "request")).robots;
      assert.deepEqual([robot.id, robot.goal], ["robot-1", { x: 3.25, y: 1.25 }]);
      assert.equal((await pressPlan(page)).status, "solved");
    },
    { allowed: REFUSED },
  );
});

test("a request without a valid map or robots can be edited", async () => {
  const noMap = [{ robots: [] }, { robots: "none", map: 3 }, { robots: [null, 7] }];
  await onPage(
    async (page) => {
      for (const request of [...noMap, { map: { rows: ["..."] } }]) {
        await editing(page, JSON.stringify(request));
        for (const name of ["wall", "box", "select"]) {
          await tool(page, name);
          await drag(page, [
            { x: 0.3, y: 0.3 },
            { x: 0.7, y: 0.7 },
          ]);
        }
        await tool(page, "robot");
        await press(page, { x: request.map?.rows ? 2.5 : 0.5, y: 0.5 }); // not in the wall
        assert.equal((await hook(page, "request")).robots.at(-1).id, "robot-1", JSON.stringify(request));
      }
    },
    { allowed: REFUSED },
  );
});

test("a robot under way is selected, not dragged; its start is where it starts", async () => {
  await onPage(async (page) => {
    await editing(page);
    await planAndPause(page);
    await seek(page, 3);
    const pose = await page.evaluate(() => window.fleetplan.poseOf("robot-2"));
    assert.ok(pose.x > 1.5);
    await drag(page, [pose, { x: 5.5, y: 2.5 }]);
    assert.deepEqual(await hook(page, "request"), REQUEST);
    await page.keyboard.press("f");
    await press(page, await page.evaluate(() => window.fleetplan.poseOf("robot-2")));
    assert.equal(await hook(page, "selected"), "robot-2");
    await drag(page, [REQUEST.robots[1].start, { x: 2.5, y: 2.5 }]);
    assert.deepEqual((await robotAt(page, 1)).start, { x: 2.5, y: 2.5 });
  });
});

test("on phones the tools stay at the lower edge of the window", async () => {
  await onPage(
    async (page) => {
      await editing(page);
      for (const top of [0, 400]) {
        await page.evaluate((y) => scrollTo(0, y), top);
        const box = await page.locator(".tool-bar").boundingBox();
        assert.ok(Math.abs(box.y + box.height - PHONE.viewport.height) < 1, `scrolled by ${top}`);
      }
    },
    { options: PHONE },
  );
});

test("the card of a robot is hidden while editing", async () => {
  await onPage(async (page) => {
    await paste(page, REQUEST);
    await pressPlan(page);
    await page.click('.robot[data-robot="robot-1"]');
    assert.equal(await page.isVisible("#inspector"), true);
    await page.click("#tab-edit");
    assert.equal(await page.isVisible("#inspector"), false);
    await page.click("#tab-plan");
    assert.equal(await page.isVisible("#inspector"), true);
  });
});

test("one finger draws, two fingers zoom and draw nothing", async () => {
  await onPage(
    async (page) => {
      await editing(page);
      await tool(page, "wall");
      const { x, y } = await windowPoint(page, { x: 3.5, y: 2.5 });
      const session = await page.context().newCDPSession(page);
      const touch = (type, ...points) =>
        session.send("Input.dispatchTouchEvent", {
          type,
          touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })),
        });
      await touch("touchStart", [x, y]);
      await touch("touchStart", [x, y], [x + 60, y]);
      await touch("touchMove", [x, y], [x + 90, y]);
      await touch("touchMove", [x, y], [x + 120, y]);
      await touch("touchEnd");
      assert.deepEqual(await hook(page, "request"), REQUEST);
      const from = await windowPoint(page, { x: 3.5, y: 2.5 });
      const to = await windowPoint(page, { x: 5.5, y: 2.5 });
      await touch("touchStart", [from.x, from.y]);
      for (let step = 1; step <= 8; step += 1) {
        await touch("touchMove", [from.x + ((to.x - from.x) * step) / 8, to.y]);
      }
      await touch("touchEnd");
      assert.equal((await rowsOf(page))[3], "...###....");
    },
    { options: PHONE },
  );
});

test("an edited example is marked as edited until the edit is undone", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "corridor-swap");
    await page.click("#tab-edit");
    const { start } = request.robots[0];
    await drag(page, [start, { ...start, x: start.x + 1 }]);
    assert.match(await page.innerText("#request-name"), /edited/);
    await undoAll(page);
    assert.equal(await chosenExample(page), "corridor-swap");
    assert.deepEqual(await hook(page, "request"), request);
  });
});

test("undo restores an edited request after another one was opened", async () => {
  await onPage(async (page) => {
    await editing(page);
    await tool(page, "wall");
    await press(page, { x: 9.5, y: 5.5 });
    const edited = await hook(page, "request");
    await choose(page, "corridor-swap");
    await page.click("#tab-edit");
    await page.click("#undo");
    await isRequest(page, JSON.stringify(edited));
    await isAnnounced(page, "is open again");
    assert.match(await page.innerText("#request-name"), /pasted|edited/);
    await page.click("#undo");
    assert.deepEqual(await hook(page, "request"), REQUEST);
  });
});
