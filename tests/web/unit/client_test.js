import assert from "node:assert/strict";
import { test } from "node:test";

import { readEvents } from "../../../web/service/client.js";

/** The events of a text that arrives in pieces of this many bytes. */
async function eventsOf(text, size = Infinity) {
  const bytes = new TextEncoder().encode(text);
  let at = 0;
  const body = new ReadableStream({
    pull(controller) {
      if (at >= bytes.length) return controller.close();
      controller.enqueue(bytes.slice(at, at + size));
      at += size;
    },
  });
  const events = [];
  for await (const event of readEvents(body)) events.push(event);
  return events;
}

const STREAM = 'event: progress\ndata: {"id":"Wägelchen 🚚"}\n\nevent: plan\ndata: {"a":": b"}\n\n';
const EVENTS = [
  { event: "progress", data: '{"id":"Wägelchen 🚚"}' },
  { event: "plan", data: '{"a":": b"}' },
];

test("events are read regardless of how the stream is split", async () => {
  for (const text of [STREAM, STREAM.replaceAll("\n", "\r\n")]) {
    for (const size of [1, 2, 3, 7, 64, 10_000])
      assert.deepEqual(await eventsOf(text, size), EVENTS, `${size}`);
  }
});

test("comments and events without data are left out, lines of data joined", async () => {
  assert.deepEqual(await eventsOf(": hello\n\nevent: nothing\n\n: well\ndata: one\ndata: two\n\n"), [
    { event: "message", data: "one\ntwo" },
  ]);
});

test("an incomplete event is dropped", async () => {
  assert.deepEqual(await eventsOf(`${STREAM}event: plan\ndata: {"a"`, 5), EVENTS);
});

test("a reader that stops cancels the stream", async () => {
  let cancelled = false;
  const body = new ReadableStream({
    start: (controller) => controller.enqueue(new TextEncoder().encode(STREAM)),
    cancel: () => {
      cancelled = true;
    },
  });
  for await (const { event } of readEvents(body)) {
    assert.equal(event, "progress");
    break;
  }
  assert.equal(cancelled, true);
});
