// Steps on fresh pages.

import assert from "node:assert/strict";

import { openPage } from "./browser.js";
import { sharedBrowser, sharedService } from "./shared.js";

/**
 * Returns a function that runs `steps(page, opened)` on a fresh page of a server with these flags. The page must have
 * no complaints, except complaints that match `allowed`, a regular expression.
 */
export function pagesFor(flags = []) {
  return async (steps, { options = {}, allowed = null, hash = "" } = {}) => {
    const { url } = await sharedService(flags);
    const opened = await openPage(await sharedBrowser(), url + hash, options);
    try {
      await steps(opened.page, { ...opened, url });
      const complaints = opened.complaints.filter((text) => !allowed?.test(text));
      assert.deepEqual(complaints, []);
    } finally {
      await opened.close();
    }
  };
}

/** Chromium's message when the service rejects a request. */
export const REFUSED = /status of 422/;

/** How a service fails to answer: what it does, by its name, and the words that the page has for it. */
export const NO_ANSWER = {
  "goes away": [(route) => route.abort(), /No response from the service/],
  "answers 503": [
    (route) =>
      route.fulfill({
        status: 503,
        contentType: "application/problem+json",
        body: JSON.stringify({ title: "Service Unavailable", detail: "The queue is full.", status: 503 }),
      }),
    /The queue is full\./,
  ],
};

/** Pastes a request, an object or a text, and waits until it is open. */
export async function paste(page, request) {
  await pasteText(page, typeof request === "string" ? request : JSON.stringify(request));
  await page.waitForSelector("#paste-form", { state: "hidden" });
}

/** Pastes a text, which need not be a request. */
export async function pasteText(page, text) {
  await page.click("#paste");
  await page.fill("#paste-text", text);
  await page.click("#paste-form button");
}

/**
 * Answers requests for plans with a stream of these events, [[name, data]], an object or a text each. The stream does
 * not end, unless it is `cut`: then it ends as a lost connection does. Returns functions that send further events and
 * end it: {send(events), end()}.
 */
export async function streamPlan(page, events, { cut = false } = {}) {
  const chunksOf = (all) => all.map(([name, data]) => `event: ${name}\ndata: ${JSON.stringify(data)}\n\n`);
  const stream = await page.evaluateHandle(
    ({ chunks, cut }) => {
      const whole = window.fetch;
      const stream = {
        /** @type {any} */ controller: null,
        send: (all) => all.forEach((chunk) => stream.controller.enqueue(new TextEncoder().encode(chunk))),
      };
      window.fetch = async (address, init) => {
        if (address !== "v1/plan") return whole(address, init);
        const body = new ReadableStream({
          start(controller) {
            stream.controller = controller;
            stream.send(chunks);
            if (cut) controller.close();
          },
        });
        return new Response(body, { headers: { "Content-Type": "text/event-stream" } });
      };
      return stream;
    },
    { chunks: chunksOf(events), cut },
  );
  return {
    send: (further) => stream.evaluate((each, chunks) => each.send(chunks), chunksOf(further)),
    end: () => stream.evaluate((each) => each.controller.close()),
  };
}

export const hook = (page, name) => page.evaluate((member) => window.fleetplan[member], name);

/** Waits until the page shows this time, seconds. */
export const hasTime = (page, time) =>
  page.waitForFunction((t) => Math.abs(window.fleetplan.time - t) < 1e-9, time);

/** The colours painted on a scene, a canvas, at places of it ({x, y}, CSS pixels), each "r,g,b". */
export async function coloursAt(page, places, canvas = "scene") {
  const parts = await painted(page, canvas, places, 0);
  return parts.map((pixels) => [...pixels.subarray(0, 3)].join());
}

/** The number of pixels of a colour, "r,g,b", within `reach` CSS pixels of a canvas place. */
export async function countColour(page, colour, place, reach) {
  const [pixels] = await painted(page, "scene", [place], reach);
  const expected = colour.split(",").map(Number);
  let found = 0;
  for (let at = 0; at < pixels.length; at += 4) {
    if (expected.every((part, offset) => pixels[at + offset] === part)) found += 1;
  }
  return found;
}

/** A custom property of the theme that is a colour as #rrggbb, as "r,g,b". */
export function themeColour(page, name) {
  return page.evaluate((property) => {
    const colour = getComputedStyle(document.documentElement).getPropertyValue(property).trim();
    return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)).join();
  }, name);
}

/** Waits until what has changed is laid out and painted. */
export const twoFrames = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/**
 * What is painted on a canvas around each of these places ({x, y}, CSS pixels). Returns the RGBA bytes of the pixels
 * that are at most `reach` CSS pixels away in x and in y, as far as the canvas reaches. The next frames are waited for.
 */
async function painted(page, id, places, reach) {
  await twoFrames(page);
  const texts = await page.evaluate(
    ({ id, places, reach }) => {
      const canvas = document.getElementById(id);
      const { width, height } = canvas;
      const scale = width / canvas.clientWidth;
      const copy = new OffscreenCanvas(width, height);
      const context = copy.getContext("2d", { willReadFrequently: true });
      context.drawImage(canvas, 0, 0);
      return places.map(({ x, y }) => {
        const [middleX, middleY] = [Math.round(x * scale), Math.round(y * scale)];
        const away = Math.min(Math.floor(reach * scale), width + height);
        const [left, top] = [Math.max(middleX - away, 0), Math.max(middleY - away, 0)];
        const [right, bottom] = [Math.min(middleX + away + 1, width), Math.min(middleY + away + 1, height)];
        if (left >= right || top >= bottom) return "";
        const { data } = context.getImageData(left, top, right - left, bottom - top);
        let text = "";
        for (let at = 0; at < data.length; at += 8192)
          text += String.fromCharCode(...data.subarray(at, at + 8192));
        return btoa(text);
      });
    },
    { id, places: places.map(({ x, y }) => ({ x, y })), reach: Math.min(reach, Number.MAX_SAFE_INTEGER) },
  );
  return texts.map((text) => Buffer.from(text, "base64"));
}
