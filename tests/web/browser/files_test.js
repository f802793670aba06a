// Opening and saving files and links, in headless Chromium against the real server.

import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { promisify } from "node:util";

import { choose, openPage, pressPlan } from "../support/browser.js";
import { drop, pgm, png, WAYS } from "../support/map_files.js";
import { hook, pagesFor, REFUSED } from "../support/on_page.js";
import { startService } from "../support/service.js";
import { sharedBrowser } from "../support/shared.js";

const onPage = pagesFor(["--max-cells", "200"]);

const requestIs = (page, request) =>
  page.waitForFunction((text) => JSON.stringify(window.fleetplan.request) === text, JSON.stringify(request));

/** Waits for the problem card and gives its words. */
async function problemOn(page) {
  await page.waitForSelector("#problem:not([hidden])");
  return page.innerText("#problem");
}

/** Waits until the dialog has these words: what a map is made into is worked out in a worker. */
const dialogSays = (page, words) =>
  page.waitForFunction(
    (pattern) => new RegExp(pattern).test(document.querySelector("dialog.form-dialog").innerText),
    words.source,
  );

const TINY = {
  map: { rows: [".....", "....."] },
  robots: [
    {
      id: "solo",
      radius: 0.3,
      linear_speed: 0.5,
      angular_speed: 1,
      start: { x: 0.5, y: 0.5 },
      goal: { x: 4.5, y: 0.5 },
    },
  ],
};
const POSES = [0.5, 4.5].map((x) => ({ x, y: 0.5, theta: 0 }));
const DRIVE = { type: "translate", t_start: 0, t_end: 8, from: POSES[0], to: POSES[1] };
const PLANS = [{ robot: "solo", cost: 8, actions: [DRIVE] }];

const MAP = "type octile\nheight 3\nwidth 6\nmap\n......\n.@@S..\n......\n";
const SCENARIO = [
  "version 1",
  ...[
    [0, 0, 5, 2],
    [0, 0, 3, 2],
    [1, 1, 0, 2],
    [5, 0, 0, 2],
  ].map((cells) => ["0", "arena.map", 6, 3, ...cells, "5.5"].join("\t")),
].join("\n");
const SPEEDS = { linear_speed: 1, angular_speed: 3.1416 };

const YAML = `image: maps/lab.pgm
resolution: 0.05
origin: [-1.1, 2.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
`;
const GRAYS = [
  [205, 205, 205, 205, 205],
  [205, 0, 0, 0, 205],
  [205, 254, 205, 254, 205],
  [205, 254, 254, 254, 205],
];

for (const [way, hand] of Object.entries(WAYS)) {
  test(`a request is opened ${way}`, async () => {
    await onPage(async (page) => {
      await hand(page, { "tiny.json": JSON.stringify(TINY, null, 2) });
      await requestIs(page, TINY);
      assert.equal(await hook(page, "answer"), null);
      assert.equal((await pressPlan(page)).status, "solved");
    });
  });

  test(`a plan file is opened ${way}, shown at once and checked`, async () => {
    await onPage(async (page) => {
      await hand(page, { "tiny.plan.json": JSON.stringify({ ...TINY, plans: PLANS }) });
      await page.waitForFunction(() => window.fleetplan.check);
      assert.deepEqual(await hook(page, "request"), TINY);
      assert.equal(await hook(page, "duration"), 8);
      assert.deepEqual((await hook(page, "check")).valid, true);
      assert.ok(await page.isVisible("#check"));
      assert.match(await page.innerText("#summary"), /Verified[^]*8\.00 s/);
    });
  });

  test(`a MovingAI map is opened ${way}, as a request without robots`, async () => {
    await onPage(async (page) => {
      await hand(page, { "arena.map": MAP.replaceAll("\n", "\r\n") });
      await requestIs(page, {
        map: { rows: ["......", ".@@...", "......"], resolution: 1 },
        robot_defaults: { radius: 0.4, ...SPEEDS },
        robots: [],
      });
      assert.match(await page.innerText("#facts"), /0 robots, 6 × 3 cells/);
      assert.ok(await page.isVisible("#panel-edit"));
    });
  });

  test(`a MovingAI scenario with its map is opened ${way}, for the chosen number of robots`, async () => {
    await onPage(async (page) => {
      await hand(page, { "arena.map.scen": SCENARIO, "arena.map": MAP });
      await page.waitForSelector("dialog.form-dialog[open]");
      assert.match(
        await page.innerText("dialog.form-dialog"),
        /Only 2 robots possible\..*: 1 where the disk does not fit, 1 where it overlaps/,
      );
      await page.fill("#scenario-count", "1");
      await page.fill("#scenario-radius", "0.5");
      await page.keyboard.press("Enter");
      await requestIs(page, {
        map: { rows: ["......", ".@@...", "......"], resolution: 1 },
        robot_defaults: { radius: 0.5, ...SPEEDS },
        robots: [{ id: "r1", start: { x: 0.5, y: 2.5, theta: 0 }, goal: { x: 5.5, y: 0.5 } }],
      });
      assert.equal((await pressPlan(page)).status, "solved");
    });
  });

  test(`a ROS map with its graymap is opened ${way}`, async () => {
    await onPage(async (page) => {
      await hand(page, { "lab.yaml": YAML, "lab.pgm": pgm(GRAYS) });
      await page.waitForSelector("dialog.form-dialog[open]");
      assert.match(await page.innerText("dialog.form-dialog"), /5 × 4 pixels of 50 mm, 60 % unknown/);
      await dialogSays(page, /3 × 3 = 9 cells of 50 mm \(at most 200\), 44 % blocked/);
      await page.click("dialog.form-dialog .primary");
      await requestIs(page, {
        map: { rows: ["###", ".#.", "..."], resolution: 0.05, origin: { x: -1.05, y: 2 } },
        robot_defaults: { radius: 0.2, ...SPEEDS },
        robots: [],
      });
    });
  });
}

test("the dialog of a ROS map previews its choices", async () => {
  await onPage(async (page) => {
    await drop(page, { "lab.yaml": YAML, "lab.pgm": pgm(GRAYS) });
    await page.waitForSelector("dialog.form-dialog[open]");
    await page.check("#ros-unknown-free");
    await page.uncheck("#ros-trim");
    await page.fill("#ros-merge", "2");
    await dialogSays(page, /3 × 2 = 6 cells of 100 mm .* 67 % blocked.*\(-1\.1, 2\) m/);
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => window.fleetplan.request.map.resolution === 0.1);
    assert.deepEqual((await hook(page, "request")).map, {
      rows: ["###", "..#"],
      resolution: 0.1,
      origin: { x: -1.1, y: 2 },
    });
  });
});

test("a ROS map with more cells than the service accepts is merged until it fits", async () => {
  await onPage(async (page) => {
    const rows = Array.from({ length: 20 }, () => Array(30).fill(254));
    await drop(page, { "lab.yaml": YAML, "lab.pgm": pgm(rows) });
    await page.waitForSelector("dialog.form-dialog[open]");
    assert.equal(await page.inputValue("#ros-merge"), "2");
    await dialogSays(page, /15 × 10 = 150 cells of 100 mm/);
    await page.fill("#ros-merge", "1");
    await dialogSays(page, /at most 200\. Merge at least 2\./);
    assert.equal(await page.isEnabled("dialog.form-dialog .primary"), false);
    await page.fill("#ros-merge", "");
    assert.equal(await page.isEnabled("dialog.form-dialog .primary"), false);
  });
});

test("a ROS map's image may be a PNG, whose alpha counts as in map_server", async () => {
  await onPage(async (page) => {
    const yaml = YAML.replace("maps/lab.pgm", "lab.png");
    await drop(page, { "lab.yaml": yaml, "lab.png": png(0, [[0, 254, 205]]) });
    await page.waitForSelector("dialog.form-dialog[open]");
    assert.equal(await page.locator("dialog.form-dialog .warnings").count(), 0);
    await page.uncheck("#ros-trim");
    await page.click("dialog.form-dialog .primary");
    await page.waitForFunction(() => window.fleetplan.request.map.rows[0] === "#.#");
    // 205 is unknown however opaque it is, and what is not opaque is unknown however light it is.
    const pixels = [
      [254, 255],
      [205, 255],
      [254, 254],
    ].flatMap(([gray, alpha]) => [gray, gray, gray, alpha]);
    await drop(page, { "lab.yaml": yaml, "lab.png": png(6, [pixels]) });
    await page.waitForSelector("dialog.form-dialog[open]");
    await page.uncheck("#ros-trim");
    await page.click("dialog.form-dialog .primary");
    await page.waitForFunction(() => window.fleetplan.request.map.rows[0] === ".##");
  });
});

test("a scenario without its map uses the map shown if the size matches", async () => {
  await onPage(async (page) => {
    await drop(page, { "arena.scen": SCENARIO });
    assert.match(
      await problemOn(page),
      /arena.scen is for the map arena.map of 6 x 3 cells.*open both together/,
    );
    await drop(page, { "arena.map": MAP });
    await page.waitForFunction(() => window.fleetplan.request.map.rows.length === 3);
    assert.equal(await page.isVisible("#problem"), false);
    await drop(page, { "arena.scen": SCENARIO });
    await page.waitForSelector("dialog.form-dialog[open]");
    await page.click("dialog.form-dialog .primary");
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 2);
  });
});

test("a cancelled dialog changes nothing and returns the focus", async () => {
  await onPage(async (page) => {
    const before = await hook(page, "request");
    await page.focus("#open");
    await drop(page, { "arena.scen": SCENARIO, "arena.map": MAP });
    await page.waitForSelector("dialog.form-dialog[open]");
    assert.ok(await page.evaluate(() => document.activeElement.closest("dialog.form-dialog") !== null));
    await page.keyboard.press("Escape");
    await page.waitForSelector("dialog.form-dialog", { state: "detached" });
    assert.equal(await page.evaluate(() => document.activeElement.id), "open");
    assert.deepEqual(await hook(page, "request"), before);
  });
});

test("the dialogs fit a phone", async () => {
  const phone = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };
  const isWithin = (page) =>
    page.evaluate(() => {
      const dialog = document.querySelector("dialog.form-dialog");
      const { left, right, top, bottom } = dialog.getBoundingClientRect();
      const scrolls = [dialog, ...dialog.querySelectorAll("*")].some((part) => {
        return part.tagName !== "INPUT" && part.scrollWidth > part.clientWidth && part.clientWidth > 0;
      });
      return !scrolls && left >= 0 && right <= innerWidth && top >= 0 && bottom <= innerHeight;
    });
  await onPage(
    async (page) => {
      await drop(page, { "arena.scen": SCENARIO, "arena.map": MAP });
      await page.waitForSelector("dialog.form-dialog[open]");
      assert.ok(await isWithin(page));
      await drop(page, { "lab.yaml": YAML, "lab.pgm": pgm(GRAYS) });
      await page.waitForSelector("#ros-merge");
      assert.ok(await isWithin(page));
    },
    { options: phone },
  );
});

test("on a phone, a problem is scrolled into view", async () => {
  const phone = { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true };
  const isInSight = (page) =>
    page.waitForFunction(() => {
      const { top, bottom } = document.getElementById("problem").getBoundingClientRect();
      return bottom > top && top >= 0 && bottom <= innerHeight;
    });
  await onPage(
    async (page) => {
      await drop(page, { "broken.json": "{" });
      await isInSight(page);
      await page.evaluate(() => scrollTo(0, 0));
      await drop(page, { "alone.json": JSON.stringify({ ...TINY, robots: [] }) });
      await page.waitForFunction(() => window.fleetplan.request.robots.length === 0);
      await page.click("#plan");
      await isInSight(page);
    },
    { options: phone, allowed: REFUSED },
  );
});

test("files dropped while a dialog is open replace it", async () => {
  await onPage(async (page) => {
    await drop(page, { "arena.scen": SCENARIO, "arena.map": MAP });
    await page.waitForSelector("dialog.form-dialog[open]");
    await drop(page, { "tiny.json": JSON.stringify(TINY) });
    await requestIs(page, TINY);
    await page.waitForSelector("dialog.form-dialog", { state: "detached" });
  });
});

test("a faulty plan is shown with its violations", async () => {
  await onPage(async (page) => {
    const fast = [{ ...PLANS[0], cost: 2, actions: [{ ...DRIVE, t_end: 2 }] }];
    await drop(page, { "fast.json": JSON.stringify({ ...TINY, plans: fast, verified: true }) });
    await page.waitForFunction(() => window.fleetplan.check);
    const { valid, violations } = await hook(page, "check");
    assert.deepEqual([valid, violations[0].kind], [false, "speed"]);
    assert.match(await page.innerText("#summary"), /Not verified/);
  });
});

test("a plan file that the service cannot check is shown with the reasons", async () => {
  await onPage(
    async (page) => {
      await drop(page, { "odd.json": JSON.stringify({ ...TINY, colour: "red", plans: PLANS }) });
      await problemOn(page);
      assert.match(await page.textContent("#problem"), /\/colour/);
      assert.equal(await hook(page, "duration"), 8);
      assert.equal(await hook(page, "check"), null);
    },
    { allowed: REFUSED },
  );
});

test("an answer is opened with its request, or for the request shown", async () => {
  await onPage(async (page) => {
    const answer = JSON.stringify({ status: "solved", plans: PLANS });
    await drop(page, { "answer.json": answer });
    assert.match(await problemOn(page), /answer.json is an answer without its request/);
    await drop(page, { "answer.json": answer, "tiny.json": JSON.stringify(TINY) });
    await page.waitForFunction(() => window.fleetplan.check?.valid);
    assert.deepEqual(await hook(page, "request"), TINY);
    await drop(page, { "tiny.json": JSON.stringify(TINY) });
    await page.waitForFunction(() => window.fleetplan.answer === null);
    await drop(page, { "answer.json": answer });
    await page.waitForFunction(() => window.fleetplan.check?.valid);
  });
});

test("files that cannot be opened are named with a remedy", async () => {
  await onPage(async (page) => {
    const before = await hook(page, "request");
    const refused = [
      [{ "broken.json": "{" }, /broken.json: It is not JSON/],
      [{ "other.json": "[1]" }, /other.json: It is JSON, but neither a request/],
      [{ "fleet.json": JSON.stringify({ ...TINY, plans: [{}] }) }, /fleet.json: plans\[0\].robot is missing/],
      [{ "arena.map": MAP.replace("@@S", "@@x") }, /arena.map: Line 6 has "x" in column 4/],
      [{ "arena.scen": "version 1\n1 2 3", "arena.map": MAP }, /arena.scen: Line 2 is/],
      [
        { "arena.scen": SCENARIO, "hall.map": "type octile\nheight 1\nwidth 6\nmap\n......\n" },
        /arena.scen: The scenario is for arena.map of 6 x 3 cells, but the map has 6 x 1: open it with its own/,
      ],
      [{ "lab.yaml": YAML }, /lab.yaml names the image lab.pgm: open both together/],
      [{ "lab.pgm": pgm(GRAYS) }, /lab.pgm is only the image.*together with its map.yaml/],
      [{ "lab.yaml": "image: lab.pgm", "lab.pgm": pgm(GRAYS) }, /lab.yaml: resolution is missing/],
      [{ "lab.yaml": YAML, "lab.pgm": "P5 9 9 255\n" }, /lab.pgm: Its pixels need 81 bytes/],
      [
        { "lab.yaml": YAML.replace("maps/lab.pgm", "lab.png"), "lab.png": png(0, [[0]]).subarray(0, 45) },
        /lab.png: It is damaged/,
      ],
      [{ "notes.docx": "PK" }, /notes.docx is not a supported file/],
      [{ "a.map": MAP, "b.json": "{}" }, /cannot be opened together: a.map is a MovingAI map, b.json is/],
    ];
    for (const [files, words] of refused) {
      await drop(page, files);
      await page.waitForFunction(
        (pattern) => new RegExp(pattern).test(document.getElementById("problem").innerText),
        words.source,
      );
      assert.equal(await page.locator("dialog.form-dialog[open]").count(), 0, "nothing covers it");
    }
    assert.deepEqual(await hook(page, "request"), before);
  });
});

async function save(page, selector) {
  if (!(await page.isVisible(selector))) await page.click("#save-menu summary");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  const folder = await mkdtemp(join(tmpdir(), "fleetplan-"));
  try {
    const path = join(folder, "saved");
    await download.saveAs(path);
    return { name: download.suggestedFilename(), content: await readFile(path) };
  } finally {
    await rm(folder, { recursive: true });
  }
}

test("a saved request and its plan can be opened again", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "corridor-swap");
    assert.equal(await page.isEnabled("#save-plan"), false);
    const answer = await pressPlan(page);
    const saved = await save(page, "#save-request");
    assert.equal(saved.name, "corridor-swap.json");
    assert.deepEqual(JSON.parse(saved.content), request);
    const plan = await save(page, "#save-plan");
    assert.equal(plan.name, "corridor-swap.plan.json");
    assert.deepEqual(JSON.parse(plan.content), { ...request, ...answer });
    await drop(page, { [plan.name]: plan.content });
    await page.waitForFunction(() => window.fleetplan.check);
    assert.equal((await hook(page, "check")).valid, true);
    assert.deepEqual(await hook(page, "request"), request);
    assert.deepEqual((await hook(page, "answer")).plans, answer.plans);
    assert.equal((await save(page, "#save-plan")).name, "corridor-swap.plan.json");
  });
});

test("a picture of the scene is saved, twice as fine", async () => {
  await onPage(async (page) => {
    const { name, content } = await save(page, "#save-picture");
    assert.match(name, /\.png$/);
    const size = await page.evaluate(() => [
      2 * document.getElementById("scene").width,
      2 * document.getElementById("scene").height,
    ]);
    assert.deepEqual([content.readUInt32BE(16), content.readUInt32BE(20)], size);
  });
});

/** Presses an entry of the save menu and gives what came to the clipboard. */
async function copied(page, selector) {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("#save-menu summary");
  const isCopied = (id) => document.querySelector(id).textContent === "Copied"; // for a moment
  await Promise.all([page.waitForFunction(isCopied, selector), page.click(selector)]);
  return page.evaluate(() => navigator.clipboard.readText());
}

test("a link holds the name of an example, or else the request itself", async () => {
  await onPage(async (page, { url }) => {
    await choose(page, "crossing");
    assert.equal(await copied(page, "#copy-link"), `${url}#crossing`);
  });
  let link;
  await onPage(async (page) => {
    await drop(page, { "tiny.json": JSON.stringify(TINY) });
    await requestIs(page, TINY);
    link = await copied(page, "#copy-link");
    await page.waitForFunction((shown) => location.href === shown, link); // the address follows
    await page.reload();
    await requestIs(page, TINY);
  });
  await onPage(
    async (page) => {
      assert.deepEqual(await hook(page, "request"), TINY);
      assert.match(await page.innerText("#request-name"), /linked request/);
      await page.evaluate(() => (location.hash = "#crossing"));
      await page.waitForFunction(() => window.fleetplan.request.robots.length === 8);
    },
    { hash: new URL(link).hash },
  );
});

test("a request that is too large for a link is reported", async () => {
  await onPage(async (page) => {
    let seed = 1;
    const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
    const robots = Array.from({ length: 300 }, (_, index) => ({
      ...TINY.robots[0],
      id: `r${index}`,
      start: { x: random(), y: random() },
      goal: { x: random(), y: random() },
    }));
    await drop(page, { "many.json": JSON.stringify({ ...TINY, robots }) });
    await page.waitForFunction(() => window.fleetplan.request.robots.length === 300);
    await page.click("#save-menu summary");
    await page.click("#copy-link");
    await page.waitForSelector("#save-note:not([hidden])");
    assert.match(await page.innerText("#save-note"), /10 cells and 300 robots.*[\d,]+ characters.*8,000/);
    await page.waitForFunction(() => location.hash.startsWith("#kept=")); // which is of this browser only
  });
});

test("a damaged link is reported, and an example is opened", async () => {
  await onPage(
    async (page) => {
      assert.match(await problemOn(page), /link is damaged or truncated/);
      assert.equal((await pressPlan(page)).status, "solved");
    },
    { hash: "#r=eJyrVspNLFCyqlYqys" },
  );
});

test("the copied command line plans the same request", async () => {
  await onPage(async (page) => {
    await drop(page, { "tiny.json": JSON.stringify(TINY) });
    await requestIs(page, TINY);
    const command = await copied(page, "#copy-curl");
    assert.match(
      command,
      /^curl -sS http:\S+\/v1\/plan -H 'Content-Type: application\/json' --data-binary @- <<'JSON'/,
    );
    assert.deepEqual(JSON.parse(command.split("\n")[1]), TINY);
  });
});

test("with a token, the copied command line presents it, also the first one", async () => {
  const folder = await mkdtemp(join(tmpdir(), "token-"));
  const file = join(folder, "token");
  await writeFile(file, "a-long-token-for-tests\n");
  const service = await startService(["--auth-token-file", file]);
  try {
    const httpCredentials = { username: "any", password: "a-long-token-for-tests" };
    const { page, close } = await openPage(await sharedBrowser(), service.url, { httpCredentials });
    const command = await copied(page, "#copy-curl");
    const run = promisify(execFile);
    const { stdout } = await run("sh", ["-c", command], {
      env: { ...process.env, TOKEN: "a-long-token-for-tests" },
    });
    assert.equal(JSON.parse(stdout).status, "solved");
    await close();
  } finally {
    await service.stop();
    await rm(folder, { recursive: true });
  }
});

test("the save menu opens, and closes by Escape, with the keyboard", async () => {
  await onPage(async (page) => {
    await page.focus("#save-menu summary");
    await page.keyboard.press("Enter");
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.id), "save-request");
    await page.keyboard.press("Escape");
    assert.equal(await page.isVisible("#save-request"), false);
    assert.equal(await page.evaluate(() => document.activeElement.tagName), "SUMMARY");
  });
});

/** A request of POST /v1/advance: the robot of TINY reports to be late. */
const REPORTED = {
  request: TINY,
  plans: PLANS,
  at: 4,
  states: [{ robot: "solo", action: 0, progress: 0.25, x: 1.5, y: 0.5 }],
};

test("a request of a later moment shows robots where they report to be, and is planned from there", async () => {
  await onPage(async (page) => {
    await drop(page, { "moment.json": JSON.stringify(REPORTED) });
    await page.waitForFunction(() => window.fleetplan.request.robots[0]?.start.x === 1.5);
    const { x } = await page.evaluate(() => window.fleetplan.poseOf("solo"));
    assert.equal(x, 1.5);
    const [robot] = (await hook(page, "request")).robots;
    assert.ok(robot.committed.length > 0, "the move under way goes on");
    const answer = await pressPlan(page);
    assert.deepEqual([answer.status, answer.plans[0].actions[0].from.x], ["solved", 1.5]);
  });
});

test("a report that cannot be is told, and what was open stays", async () => {
  await onPage(
    async (page) => {
      const before = await hook(page, "request");
      const states = [{ ...REPORTED.states[0], action: 7 }];
      await drop(page, { "moment.json": JSON.stringify({ ...REPORTED, states }) });
      await problemOn(page);
      assert.match(await page.textContent("#problem"), /\/states\/0\/action/);
      assert.deepEqual(await hook(page, "request"), before);
    },
    { allowed: REFUSED },
  );
});
