// The page in headless Chromium, against the real server.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, chosenExample, planAndPause, pressPlan, seek } from "../support/browser.js";
import { expectedGap, expectedPose, headingGap } from "../support/expected_pose.js";
import { coloursAt, hasTime, hook, pagesFor, paste, pasteText, REFUSED } from "../support/on_page.js";

const NEAR = 1e-9; // metres and radians: both sides interpolate the same doubles
const CHORDS = 5e-3; // metres: what chords of a change of speed may miss

const onPage = pagesFor();
const text = (page, selector) => page.innerText(selector);

const TINY = {
  map: { rows: [".....", "....."] },
  robots: [
    {
      id: "solo",
      radius: 0.3,
      linear_speed: 0.1,
      angular_speed: 1,
      start: { x: 0.5, y: 0.5 },
      goal: { x: 4.5, y: 1.5 },
    },
  ],
};

test("the page loads the first example and requests no other host", async () => {
  await onPage(async (page, { requested, url }) => {
    const { examples } = await page.evaluate(async () => (await fetch("v1/examples")).json());
    const first = await page.evaluate(
      async (name) => (await fetch(`v1/examples/${name}`)).json(),
      examples[0].name,
    );
    assert.deepEqual(await hook(page, "request"), first);
    assert.equal(await page.locator("#robots .robot").count(), first.robots.length);
    for (const address of requested) assert.equal(new URL(address).origin, new URL(url).origin);
  });
});

test("one click on a fresh page plans and plays", async () => {
  await onPage(async (page) => {
    await pressPlan(page);
    await page.waitForFunction(
      () =>
        window.fleetplan.playing &&
        window.fleetplan.time > 0.2 &&
        document.getElementById("play").ariaLabel === "Pause",
    );
  });
});

/** Of an example's plan the smallest gap, but for pairs at rest, is at least min_clearance. */
async function checkLeast(page, name, request, answer) {
  await page.waitForFunction(() => window.fleetplan.least);
  const { t, gap, ids } = await hook(page, "least");
  // Where speeds change, gaps are measured along chords of the motion.
  const accelerates = answer.plans.some(({ actions }) => actions.some(({ profile }) => profile));
  const near = accelerates ? CHORDS : NEAR;
  assert.ok(gap >= answer.min_clearance - near, `${name}: ${gap}, less than ${answer.min_clearance}`);
  const loads = request.robots.some(({ goals }) => goals?.some((goal) => "radius_after" in goal));
  if (!loads) assert.ok(Math.abs(expectedGap(request, answer, ids, t) - gap) < near, name);
}

test("every example loads, plans and plays its plan, whose smallest gap is known", async () => {
  await onPage(async (page) => {
    const { examples } = await page.evaluate(async () => (await fetch("v1/examples")).json());
    assert.ok(examples.length >= 3);
    for (const { name, robots } of examples) {
      const request = await choose(page, name);
      assert.equal(await page.locator("#robots .robot").count(), robots);
      const answer = await planAndPause(page);
      assert.equal(answer.verified, true, name);
      assert.equal(answer.plans.length + answer.unplanned.length, robots, name);
      const plans = new Map(answer.plans.map((plan) => [plan.robot, plan.actions]));
      for (const share of [0, 0.137, 0.5, 0.861, 1]) {
        const time = answer.makespan * share;
        await seek(page, time);
        await hasTime(page, time);
        const ids = request.robots.map(({ id }) => id);
        const drawn = await page.evaluate((all) => all.map((id) => window.fleetplan.poseOf(id)), ids);
        request.robots.forEach((robot, at) => {
          const expected = expectedPose(robot.start, plans.get(robot.id) ?? [], time, robot);
          const where = `${name}: ${robot.id} at ${time}`;
          assert.ok(Math.hypot(drawn[at].x - expected.x, drawn[at].y - expected.y) < NEAR, where);
          assert.ok(headingGap(drawn[at].theta, expected.theta) < NEAR, where);
        });
      }
      await checkLeast(page, name, request, answer);
    }
  });
});

test("the page draws the deterministic plan that the service returns", async () => {
  await onPage(async (page, { url }) => {
    const request = await choose(page, "corridor-swap");
    const shown = await pressPlan(page);
    const response = await fetch(new URL("v1/plan", url), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(request),
    });
    const answer = await response.json();
    assert.equal(shown.deterministic, true);
    assert.deepEqual(shown.plans, answer.plans);
  });
});

/** The colours painted at offsets from a robot's centre, in its radii, x right and y up. */
async function coloursAround(page, id, offsets) {
  const { x, y, radius } = await page.evaluate((robot) => window.fleetplan.screenOf(robot), id);
  return coloursAt(
    page,
    offsets.map(([right, up]) => ({ x: x + right * radius, y: y - up * radius })),
  );
}

const FLOOR = "255,255,255";

test("a robot is painted where its pose is", async () => {
  await onPage(async (page) => {
    await paste(page, TINY);
    await planAndPause(page);
    await seek(page, 20);
    await hasTime(page, 20);
    const { theta } = await page.evaluate(() => window.fleetplan.poseOf("solo"));
    const beside = (radii) => [-Math.sin(theta) * radii, Math.cos(theta) * radii];
    const [inside, outside] = await coloursAround(page, "solo", [beside(0.8), beside(1.3)]);
    assert.equal(outside, FLOOR);
    assert.notEqual(inside, FLOOR);
  });
});

test("a wide map's cells are painted where they are, top row first", async () => {
  await onPage(async (page) => {
    const row = (wall) => [...Array(4000)].map((_, column) => (column === wall ? "#" : ".")).join("");
    const start = { x: 2047.5, y: 1.5 };
    await paste(page, {
      map: { rows: [row(2047), row(2048), row()] },
      robots: [{ ...TINY.robots[0], radius: 0.25, start, goal: undefined }],
    });
    const middle = await page.locator("#scene").boundingBox();
    for (let turns = 0; turns < 40; turns += 1) {
      const { x, y, radius } = await page.evaluate(() => window.fleetplan.screenOf("solo"));
      if (radius > 8) break;
      await page.mouse.move(middle.x + x, middle.y + y);
      await page.mouse.wheel(0, -240);
    }
    const cells = [
      [4, 0],
      [0, 4],
      [-4, 0],
      [0, -4],
    ];
    const [right, above, left, below] = await coloursAround(page, "solo", cells);
    assert.equal(right, above);
    assert.notEqual(right, FLOOR);
    assert.deepEqual([left, below], [FLOOR, FLOOR]);
  });
});

test("the scrubber, its keys and the page's keys move through the plan", async () => {
  await onPage(async (page) => {
    await paste(page, TINY); // which plays for 40 s
    const answer = await pressPlan(page);
    await page.waitForFunction(() => window.fleetplan.playing);
    await page.keyboard.press("Space");
    assert.equal(await hook(page, "playing"), false);
    await seek(page, 2);
    await hasTime(page, 2);
    await page.focus("#scrubber");
    await page.keyboard.press("ArrowRight");
    await hasTime(page, 2.25);
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("ArrowLeft");
    await hasTime(page, 1.75);
    await page.keyboard.press("Home");
    await hasTime(page, 0);
    await page.keyboard.press("End");
    await hasTime(page, await hook(page, "duration"));
    assert.ok(Math.abs((await hook(page, "duration")) - answer.makespan) < NEAR);
    await page.keyboard.press("r");
    await hasTime(page, 0);
    await page.keyboard.press("l");
    assert.equal(await page.getAttribute("#loop", "aria-pressed"), "true");
    await page.keyboard.press("]");
    assert.equal(await page.inputValue("#speed"), "2");
    await page.keyboard.press("Space");
    assert.equal(await hook(page, "playing"), true);
  });
});

test("a plan rests at its end when it has played", async () => {
  await onPage(async (page) => {
    const answer = await pressPlan(page);
    await page.selectOption("#speed", "16");
    await page.waitForFunction(() => window.fleetplan.time > 0 && !window.fleetplan.playing);
    assert.ok(Math.abs((await hook(page, "time")) - answer.makespan) < NEAR);
    const [moved] = answer.plans.filter(({ actions }) => actions.length > 0);
    assert.equal(await page.evaluate((id) => window.fleetplan.stateOf(id), moved.robot), "arrived");
  });
});

test("wheel, drag and the fit key move the camera", async () => {
  await onPage(async (page) => {
    const [{ id }] = (await hook(page, "request")).robots;
    const at = () => page.evaluate((robot) => window.fleetplan.screenOf(robot), id);
    const box = await page.locator("#scene").boundingBox();
    const fitted = await at();
    await page.mouse.move(box.x + fitted.x, box.y + fitted.y);
    await page.mouse.wheel(0, -300);
    await page.waitForFunction(
      ([robot, radius]) => window.fleetplan.screenOf(robot).radius > radius * 1.2,
      [id, fitted.radius],
    );
    const zoomed = await at();
    assert.ok(Math.hypot(zoomed.x - fitted.x, zoomed.y - fitted.y) < 1, "the point under the pointer stays");
    await page.mouse.down();
    await page.mouse.move(box.x + fitted.x + 80, box.y + fitted.y + 30, { steps: 4 });
    await page.mouse.up();
    const dragged = await at();
    assert.ok(Math.hypot(dragged.x - zoomed.x, dragged.y - zoomed.y) > 5);
    await page.keyboard.press("f");
    assert.deepEqual(await at(), fitted);
  });
});

test("two fingers zoom the scene", async () => {
  await onPage(
    async (page) => {
      const [{ id }] = (await hook(page, "request")).robots;
      const radius = () => page.evaluate((robot) => window.fleetplan.screenOf(robot).radius, id);
      const box = await page.locator("#scene").boundingBox();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
      const session = await page.context().newCDPSession(page);
      const touch = (type, apart) =>
        session.send("Input.dispatchTouchEvent", {
          type,
          touchPoints:
            apart === null ? [] : [-apart, apart].map((offset, at) => ({ x: x + offset, y, id: at })),
        });
      const before = await radius();
      await touch("touchStart", 40);
      for (const apart of [50, 60, 70, 80]) await touch("touchMove", apart);
      await touch("touchEnd", null);
      assert.ok(Math.abs((await radius()) / before - 2) < 0.1, `${(await radius()) / before} is not about 2`);
    },
    { options: { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true } },
  );
});

test("a robot is selected from the list and from the scene", async () => {
  await onPage(async (page) => {
    const [first, second] = (await hook(page, "request")).robots;
    const row = (id) => page.locator(`.robot[data-robot="${id}"]`);
    await row(first.id).click();
    assert.equal(await row(first.id).getAttribute("aria-pressed"), "true");
    assert.match(await text(page, "#readout"), new RegExp(`^${first.id}: ready at`));
    const box = await page.locator("#scene").boundingBox();
    const { x, y } = await page.evaluate((id) => window.fleetplan.screenOf(id), second.id);
    await page.mouse.click(box.x + x, box.y + y);
    assert.equal(await row(first.id).getAttribute("aria-pressed"), "false");
    assert.equal(await row(second.id).getAttribute("aria-pressed"), "true");
    await page.keyboard.press("Escape");
    assert.equal(await row(second.id).getAttribute("aria-pressed"), "false");
  });
});

test("an invalid request shows each error's pointer and detail", async () => {
  await onPage(
    async (page) => {
      await paste(page, {
        ...TINY,
        robots: [{ ...TINY.robots[0], radius: -1, start: { x: "left", y: 0.5 } }],
      });
      await page.click("#plan");
      await page.waitForSelector("#problem:not([hidden])");
      const problem = await page.evaluate(async () => {
        const body = JSON.stringify(window.fleetplan.request);
        const headers = { "Content-Type": "application/json" };
        return (await fetch("v1/plan", { method: "POST", headers, body })).json();
      });
      const shown = await page.textContent("#problem"); // with the details
      assert.equal(problem.status, 422);
      assert.ok(problem.errors.some(({ pointer }) => pointer === "/robots/0/start/x"));
      assert.ok(shown.includes(problem.title));
      for (const { pointer, detail } of problem.errors) {
        assert.ok(shown.includes(pointer), pointer);
        assert.ok(shown.includes(detail), detail);
      }
    },
    { allowed: REFUSED },
  );
});

test("an error that points to a robot selects it", async () => {
  await onPage(
    async (page) => {
      await paste(page, { ...TINY, robots: [{ ...TINY.robots[0], goal: { x: 40, y: 1.5 } }] });
      await page.click("#plan");
      await page.click("#problem .error");
      assert.equal(await page.getAttribute('.robot[data-robot="solo"]', "aria-pressed"), "true");
    },
    { allowed: REFUSED },
  );
});

test("an address can name an example", async () => {
  await onPage(async (page) => assert.equal(await chosenExample(page), "partly-solvable"), {
    hash: "#partly-solvable",
  });
});

test("text that is not JSON is rejected at once", async () => {
  await onPage(async (page) => {
    await pasteText(page, "{ not json");
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(await text(page, "#problem"), /not JSON/);
  });
});

test("robots without a plan are listed with their reason", async () => {
  await onPage(async (page) => {
    await choose(page, "partly-solvable");
    const answer = await pressPlan(page);
    assert.equal(answer.status, "partial");
    const shown = await text(page, "#unplanned");
    for (const { robot, detail, blocked_by } of answer.unplanned) {
      for (const part of [robot, detail, ...blocked_by]) assert.ok(shown.includes(part), part);
      // Rows of the list are filled with the next frame.
      await page.locator(`.robot[data-robot="${robot}"]`, { hasText: "unplanned" }).waitFor();
    }
    assert.match(await text(page, "#summary"), /Partially solved/);
  });
});

test("the figures are those of the answer", async () => {
  await onPage(async (page) => {
    await choose(page, "corridor-swap");
    const answer = await pressPlan(page);
    const shown = await text(page, "#summary");
    for (const part of ["Solved", "Verified", answer.flowtime.toFixed(2), answer.makespan.toFixed(2)]) {
      assert.ok(shown.includes(part), part);
    }
    assert.ok(shown.includes(`write ${answer.timings_ms.serialize.toFixed(2)} ms`));
  });
});

/** Two robots that change sides, with a minute to do it better. */
const SWAP = {
  ...TINY,
  robots: ["a", "b"].map((id, at) => ({
    ...TINY.robots[0],
    id,
    start: { x: 0.5 + 4 * at, y: 0.5 },
    goal: { x: 4.5 - 4 * at, y: 0.5 },
  })),
  options: { mode: "anytime", time_budget_ms: 60_000 },
};

test("planning reports progress, and cancelling keeps the best plan", async () => {
  await onPage(async (page) => {
    await paste(page, SWAP);
    await page.click("#plan");
    await page.waitForFunction(() => {
      const [, elapsed] = /^Planning (\d+\.\d) of 60\.0 s$/.exec(
        document.getElementById("elapsed").textContent,
      );
      return Number(elapsed) >= 0.3;
    });
    await page.waitForFunction(() =>
      /^2 of 2 robots planned(, attempt [\d,]+)?, flowtime [\d.]+ s, makespan [\d.]+ s$/.test(
        document.getElementById("so-far").textContent,
      ),
    );
    assert.ok((await page.evaluate(() => document.getElementById("budget").position)) > 0);
    await page.click("#cancel");
    await page.waitForSelector("#cancel", { state: "hidden" });
    const kept = await hook(page, "answer");
    assert.deepEqual([kept.status, kept.verified, kept.deterministic], ["solved", true, false]);
    assert.match(await text(page, "#announcer"), /cancelled: this is the best plan so far/);
    assert.equal(await page.isVisible("#planning"), false);
    assert.equal(await page.isEnabled("#plan"), true);
  });
});

test("planning that is cancelled before the first plan leaves none", async () => {
  await onPage(async (page) => {
    await page.route("**/v1/plan", () => {}); // is never answered
    await page.click("#plan");
    await page.click("#cancel");
    await page.waitForSelector("#cancel", { state: "hidden" });
    assert.equal(await hook(page, "answer"), null);
    assert.equal(await text(page, "#announcer"), "Planning cancelled.");
    assert.equal(await page.isEnabled("#plan"), true);
  });
});

test("a plan that arrives late is not shown for another request", async () => {
  await onPage(async (page) => {
    await paste(page, SWAP);
    await page.click("#plan");
    await page.waitForFunction(() => /flowtime/.test(document.getElementById("so-far").textContent));
    await choose(page, "crossing");
    assert.equal(await hook(page, "answer"), null);
    assert.equal(await page.isVisible("#planning"), false);
  });
});

test("a plan that is returned without events is shown", async () => {
  await onPage(async (page) => {
    await page.route("**/v1/plan", (route, request) =>
      route.continue({ headers: { ...request.headers(), accept: "application/json" } }),
    );
    assert.equal((await pressPlan(page)).verified, true);
  });
});

test("a stream that ends with a problem, or too early, is reported", async () => {
  await onPage(async (page) => {
    const end = async (body, shown) => {
      await page.route("**/v1/plan", (route) => route.fulfill({ contentType: "text/event-stream", body }));
      await page.click("#plan");
      await page.waitForFunction(
        (words) => document.getElementById("problem").innerText.includes(words),
        shown,
      );
      await page.unroute("**/v1/plan");
    };
    const progress = { elapsed_ms: 1, attempt: 1, planned: 0, robots: 1, best: null };
    const begin = `event: progress\ndata: ${JSON.stringify(progress)}\n\n`;
    await end(begin, "No response from the service");
    const problem = { title: "Internal Server Error", status: 500, detail: "A bug.", errors: [] };
    await end(`${begin}event: problem\ndata: ${JSON.stringify(problem)}\n\n`, "Internal Server Error");
  });
});

test("an unreachable service is reported", async () => {
  await onPage(
    async (page) => {
      await page.route("**/v1/plan", (route) => route.abort());
      await page.click("#plan");
      await page.waitForSelector("#problem:not([hidden])");
      assert.match(await text(page, "#problem"), /No response from the service/);
    },
    { allowed: /ERR_FAILED/ },
  );
});

test("with reduced motion a plan waits to be played", async () => {
  await onPage(
    async (page) => {
      await pressPlan(page);
      assert.deepEqual([await hook(page, "playing"), await hook(page, "time")], [false, 0]);
      assert.equal(await page.isEnabled("#play"), true);
    },
    { options: { reducedMotion: "reduce" } },
  );
});

test("every control has a name and is reached with the keyboard", async () => {
  await onPage(async (page) => {
    await pressPlan(page);
    const controls = await page.evaluate(() =>
      [...document.querySelectorAll("button, select, input, textarea, summary, canvas:not([aria-hidden])")]
        .filter((control) => control.checkVisibility() && !control.disabled)
        .map((control) => ({
          id: control.id || control.dataset.robot || control.textContent,
          named: Boolean(control.ariaLabel || control.labels?.length || control.textContent.trim()),
          reached: control.tabIndex >= 0 || control.role === "tab" || control.matches(".robot"), // others by arrows
        })),
    );
    assert.ok(controls.length > 15);
    for (const control of controls) assert.ok(control.named && control.reached, JSON.stringify(control));
  });
});

test("on a desktop the page fills the height of the window", async () => {
  await onPage(async (page) => {
    await choose(page, "warehouse");
    await pressPlan(page);
    const heights = await page.evaluate(() => [document.documentElement.scrollHeight, window.innerHeight]);
    assert.deepEqual(heights, [900, 900]);
  });
});

test("a phone shows the page without scrolling sideways", async () => {
  await onPage(
    async (page) => {
      await choose(page, "partly-solvable");
      await pressPlan(page);
      const widths = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
      assert.deepEqual(widths, [390, 390]);
      const play = await page.locator("#play").boundingBox();
      assert.ok(play.y + play.height <= 844, "the playback bar is in sight");
      const last = page.locator("#robots .robot").last();
      await last.scrollIntoViewIfNeeded();
      assert.ok((await last.boundingBox()).height > 30, "the list of robots is below");
    },
    { options: { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true } },
  );
});

/** On the page: whether a picture is of a map with robots. */
function isDrawn(canvas) {
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {
    willReadFrequently: true,
  });
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  return new Set(new Uint32Array(data.buffer)).size > 10;
}

for (const width of [1440, 390]) {
  test(`the examples are pictures with whole names, drawn as they come into sight, ${width} pixels`, async () => {
    await onPage(
      async (page) => {
        await page.click("#open-gallery");
        const cut = await page.$$eval(".example", (items) =>
          items
            .filter((item) => {
              const [inner, outer] = [item, item.parentElement].map((part) => part.getBoundingClientRect());
              return item.scrollWidth > item.clientWidth || inner.bottom > outer.bottom;
            })
            .map(({ textContent }) => textContent),
        );
        assert.deepEqual(cut, []);
        const pictures = page.locator(".example canvas");
        await page.waitForFunction(isDrawn, await pictures.first().elementHandle());
        assert.equal(await pictures.last().evaluate(isDrawn), false, "not before it is in sight");
        await page.evaluate(() => document.getElementById("gallery").scrollBy(0, 10_000));
        await page.waitForFunction(isDrawn, await pictures.last().elementHandle());
      },
      { options: { viewport: { width, height: 844 } } },
    );
  });
}

test("examples are chosen in the gallery by a click and by keys", async () => {
  await onPage(async (page) => {
    const { examples } = await page.evaluate(async () => (await fetch("v1/examples")).json());
    const isOpen = async ({ name, title, robots }) => {
      await page.waitForFunction((count) => window.fleetplan.request.robots.length === count, robots);
      assert.equal(await text(page, "#request-name"), title);
      assert.equal(await chosenExample(page), name);
    };
    await page.click("#open-gallery");
    await page.click(`.example[data-example="${examples[1].name}"]`);
    await isOpen(examples[1]);
    assert.equal(await page.isVisible("#gallery"), false);
    await page.click("#open-gallery");
    const focused = () => page.evaluate(() => /** @type {any} */ (document.activeElement).dataset.example);
    assert.equal(await focused(), examples[1].name, "it begins at the one that is open");
    await page.keyboard.press("Tab");
    assert.equal(await focused(), examples[2].name);
    assert.ok(
      (await page.innerText(`.example[data-example="${examples[2].name}"]`)).includes(
        examples[2].description,
      ),
    );
    await page.keyboard.press("Enter");
    await isOpen(examples[2]);
  });
});
