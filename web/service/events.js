// Reading a stream of events (server-sent events, WHATWG HTML), which EventSource cannot as it only asks by GET.

const END_OF_EVENT = /\r?\n\r?\n/;

/** The events of a body (a ReadableStream of bytes) as they come: {event, data}; comments are left out. */
export async function* readEvents(body) {
  const decoder = new TextDecoder();
  const reader = body.getReader();
  let parts = []; // of the event at hand, which may be long and come in many pieces
  let tail = ""; // of them; an end may lie across pieces
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      const part = decoder.decode(value, { stream: true });
      parts.push(part);
      const ends = END_OF_EVENT.test(tail + part);
      tail = (tail + part).slice(-3);
      if (!ends) continue;
      const blocks = parts.join("").split(END_OF_EVENT);
      parts = [blocks.pop()];
      tail = parts[0].slice(-3);
      for (const block of blocks) {
        const read = readEvent(block);
        if (read.data !== "") yield read;
      }
    }
  } finally {
    await reader.cancel().catch(() => {}); // whoever stops reading wants no more
  }
}

function readEvent(block) {
  const data = [];
  let event = "message";
  for (const line of block.split(/\r?\n/)) {
    const [, field, value] = /^([^:]*):? ?(.*)$/s.exec(line);
    if (field === "event") event = value;
    if (field === "data") data.push(value);
  }
  return { event, data: data.join("\n") };
}
