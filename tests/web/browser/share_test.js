// What is saved for others: a picture, an animation, and a page that needs no server.

import assert from "node:assert/strict";
import { mkdtemp, readFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

import { choose, newContext, pause, pressPlan } from "../support/browser.js";
import { png } from "../support/map_files.js";
import { coloursAt, countColour, hook, pagesFor, paste } from "../support/on_page.js";

const onBundle = pagesFor();
const onSources = pagesFor(["--web-root", fileURLToPath(new URL("../../../web", import.meta.url))]);

/** The file that pressing a button of the Save menu saves: {name, path}. */
async function saved(page, button) {
  if (!(await page.isVisible(button))) {
    await page.focus("#save-menu summary");
    await page.keyboard.press("Enter");
  }
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    (async () => {
      await page.focus(button);
      await page.keyboard.press("Enter");
    })(),
  ]);
  const name = download.suggestedFilename();
  const path = join(await mkdtemp(join(tmpdir(), "fleetplan-")), name);
  await download.saveAs(path);
  return { name, path };
}

test("a picture has twice the pixels of the scene", async () => {
  await onBundle(async (page) => {
    const { name, path } = await saved(page, "#save-picture");
    assert.match(name, /\.png$/);
    const bytes = await readFile(path);
    const { width, height } = await page.evaluate(() => {
      const { clientWidth, clientHeight } = document.getElementById("scene");
      return { width: clientWidth, height: clientHeight };
    });
    assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [2 * width, 2 * height]);
    assert.equal(await page.evaluate(() => document.getElementById("scene").width), width);
  });
});

const SHORT = {
  map: { rows: ["....."] },
  robots: [
    {
      id: "solo",
      radius: 0.3,
      linear_speed: 2,
      angular_speed: 3,
      start: { x: 0.5, y: 0.5 },
      goal: { x: 4.5, y: 0.5 },
    },
  ],
};

/** On another page, without the policy of content: what `read(video)` resolves to, of a file; the video is loaded. */
async function readVideo(page, path, read) {
  const bytes = await readFile(path);
  assert.equal(bytes.readUInt32BE(0), 0x1a45dfa3, "EBML");
  const other = await page.context().newPage();
  const video = await other.evaluateHandle((base64) => {
    const made = document.createElement("video");
    made.src = `data:video/webm;base64,${base64}`;
    made.muted = true;
    return new Promise((loaded, fail) => {
      made.addEventListener("loadedmetadata", () => loaded(made));
      made.addEventListener("error", () => fail(made.error));
    });
  }, bytes.toString("base64"));
  return video.evaluate(read);
}

/**
 * On the page: seeks through a video. Returns its duration and size, and how many of three pictures differ, in their
 * left and in their right half.
 */
async function lookThrough(video) {
  const { duration, videoWidth, videoHeight } = video;
  const context = new OffscreenCanvas(videoWidth, videoHeight).getContext("2d", { willReadFrequently: true });
  const middle = Math.floor(videoWidth / 2);
  const halves = [0, middle].map((left) => ({ left, pictures: new Set() }));
  for (const share of [0, 0.5, 0.99]) {
    // A video may have sought before its picture is there to be drawn.
    const presented = new Promise((done) => video.requestVideoFrameCallback(done));
    video.currentTime = share * duration;
    await new Promise((done) => video.addEventListener("seeked", done, { once: true }));
    await Promise.race([presented, new Promise((done) => setTimeout(done, 1000))]); // if it is there already
    context.drawImage(video, 0, 0);
    for (const { left, pictures } of halves) {
      const { data } = context.getImageData(left, 0, middle, videoHeight);
      pictures.add(new Uint32Array(data.buffer).reduce((sum, pixel) => (sum * 31 + pixel) >>> 0, 0));
    }
  }
  return { duration, videoWidth, videoHeight, different: halves.map(({ pictures }) => pictures.size) };
}

test("an animation is encoded picture by picture, with its duration, and the time before is shown again", async () => {
  await onBundle(async (page) => {
    await paste(page, SHORT);
    const { makespan } = await pressPlan(page);
    await pause(page);
    const time = await hook(page, "time");
    const { name, path } = await saved(page, "#save-animation");
    assert.match(name, /\.webm$/);
    assert.equal(await hook(page, "time"), time);
    const { duration, videoWidth, different } = await readVideo(page, path, lookThrough);
    assert.ok(Math.abs(duration - (makespan + 0.6)) < 0.05, `${duration} s of ${makespan} s and a rest`);
    assert.equal(videoWidth, await page.evaluate(() => document.getElementById("scene").width));
    assert.equal(Math.max(...different), 3, "the robot moves");
    assert.ok((await page.innerText("#save-animation")).startsWith("Animation"));
  });
});

test("pictures and animations show both plans that are compared", async () => {
  await onBundle(async (page) => {
    await paste(page, SHORT);
    await pressPlan(page);
    await pressPlan(page);
    await page.click("#tab-analyse");
    await page.getByText("Compare plans", { exact: true }).click();
    await page.getByLabel("Compare the plan with").selectOption("before 0");
    const { width, height } = await page.evaluate(() => {
      const { clientWidth, clientHeight } = document.getElementById("scene-frame");
      return { width: clientWidth, height: clientHeight };
    });
    const picture = await readFile((await saved(page, "#save-picture")).path);
    assert.deepEqual([picture.readUInt32BE(16), picture.readUInt32BE(20)], [2 * width, 2 * height]);
    const { path } = await saved(page, "#save-animation");
    const { videoWidth, videoHeight, different } = await readVideo(page, path, lookThrough);
    assert.deepEqual([videoWidth, videoHeight], [width, height]);
    assert.deepEqual(different, [3, 3], "the robot moves in both plans");
  });
});

test("without an encoder of pictures, an animation is recorded while the whole plan is played", async () => {
  await onBundle(async (page) => {
    await page.evaluate(() => delete window.VideoEncoder);
    await paste(page, SHORT);
    const { makespan } = await pressPlan(page);
    await page.evaluate(() => {
      window.recorded = []; // the times of the plan from which and to which it is recorded
      for (const name of ["start", "stop"]) {
        const done = MediaRecorder.prototype[name];
        MediaRecorder.prototype[name] = function () {
          window.recorded.push(window.fleetplan.time);
          done.call(this);
        };
      }
    });
    const { path } = await saved(page, "#save-animation");
    assert.deepEqual(await page.evaluate(() => window.recorded), [0, makespan]);
    const lasts = await readVideo(page, path, async (video) => {
      const ended = new Promise((done) => video.addEventListener("ended", done));
      await video.play();
      await ended;
      return video.currentTime;
    });
    assert.ok(lasts > 0, "it plays, with as many frames as the machine had time for");
  });
});

for (const [how, onPage] of [
  ["the bundle", onBundle],
  ["the sources", onSources],
]) {
  test(`a standalone page shows the plan without a server, made from ${how}`, async () => {
    await onPage(async (page) => {
      await choose(page, "hospital-ward");
      await pressPlan(page);
      await page.waitForFunction(() => window.fleetplan.time > 0);
      const answer = await pressPlan(page);
      await page.click("#tab-analyse");
      await page.getByText("Compare plans", { exact: true }).click();
      await page.getByLabel("Compare the plan with").selectOption("before 0");
      const { name, path } = await saved(page, "#save-page");
      assert.equal(name, "hospital-ward.html");
      const away = await newContext(page.context().browser(), { offline: true });
      try {
        const other = await away.newPage();
        const complaints = [];
        other.on("console", (message) => complaints.push(message.text()));
        other.on("pageerror", (error) => complaints.push(String(error)));
        await other.goto(pathToFileURL(path).href);
        const end = `${answer.makespan.toFixed(2)} s`;
        await other.waitForFunction(
          (words) => document.getElementById("clock").textContent.endsWith(words),
          end,
        );
        await other.keyboard.press("Space");
        await other.waitForFunction(() => parseFloat(document.getElementById("clock").textContent) > 0.3);
        const colours = await other.evaluate(() => {
          const canvas = document.getElementById("scene");
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return new Set(new Uint32Array(data.buffer)).size;
        });
        assert.ok(colours > 20);
        assert.equal(await other.locator("#travel, #travel-choice").count(), 0, "what needs a service");
        assert.equal(
          await other.locator("canvas").count(),
          1,
          "of the plan, not of what it is compared with",
        );
        const [scene, frame] = ["#scene", "#scene-frame"].map((id) => other.locator(id).boundingBox());
        assert.equal((await scene).width, (await frame).width);
        assert.match(await other.innerText("#facts"), /^10 robots, flowtime /);
        assert.deepEqual(complaints, []);
      } finally {
        await away.close();
      }
      assert.deepEqual(await hook(page, "answer"), answer);
    });
  });
}

/** A robot passes a wall and a zone, which leave the top row of their columns free. */
const [WALL, ZONE] = [2, 6]; // columns
const columnOf = (dark) =>
  Array.from({ length: 5 }, (_, row) =>
    Array.from({ length: 10 }, (__, column) => (column === dark && row > 0 ? 0 : 254)),
  );
const imageOf = (dark) => ({ png: png(0, columnOf(dark)).toString("base64") });
const MASKED = {
  map: { image: { ...imageOf(WALL), resolution: 1 } },
  zones: [{ id: "keepout", type: "blocked", mask: imageOf(ZONE) }],
  robots: [{ ...SHORT.robots[0], goal: { x: 9.5, y: 0.5 } }],
};

test("a page to send draws the image of a map and the mask of a zone", async () => {
  await onBundle(async (page) => {
    await paste(page, MASKED);
    await page.waitForFunction(() => window.fleetplan.request.zones);
    await pressPlan(page);
    const places = await page.evaluate(
      (columns) => columns.map((column) => window.fleetplan.pointOf({ x: column + 0.2, y: 1.2 })),
      [WALL, ZONE],
    );
    const [wall, mask] = await coloursAt(page, places);
    assert.notEqual(wall, mask);
    const { path } = await saved(page, "#save-page");
    const away = await newContext(page.context().browser(), { offline: true });
    try {
      const other = await away.newPage();
      await other.goto(pathToFileURL(path).href);
      await other.waitForFunction(() => document.getElementById("facts").textContent.startsWith("1 robot"));
      for (const [what, colour] of Object.entries({ wall, mask })) {
        const pixels = await countColour(other, colour, { x: 0, y: 0 }, Infinity);
        assert.ok(pixels > 1000, `${pixels} pixels of the ${what}`);
      }
    } finally {
      await away.close();
    }
  });
});
