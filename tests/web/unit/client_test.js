import assert from "node:assert/strict";
import { test } from "node:test";

import { ProblemError } from "../../../web/model/problem.js";
import { plan, readEvents } from "../../../web/service/client.js";

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

/** Calls steps(requests) while fetch is answered by one response after the other: {status, retry_after, answer}. */
async function answering(responses, steps) {
  const whole = globalThis.fetch;
  const requests = [];
  globalThis.fetch = async (address) => {
    requests.push(address);
    const { status, retry_after, answer } = responses[Math.min(requests.length, responses.length) - 1];
    const headers = retry_after === undefined ? {} : { "Retry-After": String(retry_after) };
    return new Response(JSON.stringify(answer ?? { title: "Service Unavailable" }), { status, headers });
  };
  try {
    await steps(requests);
  } finally {
    globalThis.fetch = whole;
  }
}

test("a busy service is asked again when it says", async () => {
  const busy = { status: 503, retry_after: 0.01 };
  const answer = { status: "none", plans: [], unplanned: [], flowtime: 0, makespan: 0, warnings: [] };
  await answering([busy, busy, { status: 200, answer }], async (requests) => {
    const waits = [];
    const listener = { waiting: (seconds) => waits.push(seconds) };
    assert.deepEqual(await plan("{}", undefined, listener), answer);
    assert.deepEqual([requests.length, waits], [3, [0.01, 0.01]]);
  });
});

test("a service that stays busy, or does not say for how long, is reported", async () => {
  for (const [response, attempts] of [
    [{ status: 503, retry_after: 0.01 }, 6],
    [{ status: 503, retry_after: 3600 }, 1],
    [{ status: 503 }, 1],
    [{ status: 429, retry_after: 0.01 }, 1],
  ]) {
    await answering([response], async (requests) => {
      await assert.rejects(plan("{}", undefined, { waiting: () => {} }), ProblemError);
      assert.equal(requests.length, attempts);
    });
  }
});

test("waiting for a busy service ends when it is aborted", async () => {
  await answering([{ status: 503, retry_after: 30 }], async (requests) => {
    const control = new AbortController();
    const asked = plan("{}", control.signal, { waiting: () => control.abort() });
    await assert.rejects(asked, { name: "AbortError" });
    assert.equal(requests.length, 1);
  });
});
