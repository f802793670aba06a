// The file of a video, read as players do.

import assert from "node:assert/strict";
import { test } from "node:test";

import { writeWebm } from "../../../web/share/webm.js";

const CONTAINERS = new Set([
  "18538067",
  "1549a966",
  "1654ae6b",
  "ae",
  "e0",
  "1c53bb6b",
  "bb",
  "b7",
  "1f43b675",
  "1a45dfa3",
]);

/** The elements of some bytes: [{id, at, value: their bytes, or the elements in them}]. */
function elementsOf(bytes, from = 0, until = bytes.length) {
  const found = [];
  for (let at = from; at < until; ) {
    const idLength = Math.clz32(bytes[at]) - 23;
    const id = bytes.subarray(at, at + idLength).toString("hex");
    const size = Number(bytes.readBigUInt64BE(at + idLength) & 0xffffffffffffffn);
    const begin = at + idLength + 8;
    assert.equal(bytes[at + idLength], 1, "a length of eight bytes");
    assert.ok(begin + size <= until, id);
    const value = CONTAINERS.has(id)
      ? elementsOf(bytes, begin, begin + size)
      : bytes.subarray(begin, begin + size);
    found.push({ id, at, begin, value });
    at = begin + size;
  }
  return found;
}

const only = (elements, id) => elements.find((each) => each.id === id);
const numberIn = ({ value }) => Number(value.readBigUInt64BE(0));

test("a file has the duration, the size and all pictures, and its index leads to each key", () => {
  const pictures = Array.from({ length: 7 }, (_, at) => ({
    data: Uint8Array.of(at, at, at),
    time: Math.round((at * 1000) / 30),
    isKey: at % 3 === 0,
  }));
  const parts = writeWebm({ codec: "V_VP8", width: 640, height: 361, duration: 233.5 }, pictures);
  const [header, segment] = elementsOf(Buffer.concat(parts));
  assert.equal(only(header.value, "4282").value.toString(), "webm");
  const info = only(segment.value, "1549a966").value;
  assert.equal(only(info, "4489").value.readDoubleBE(0), 233.5);
  const track = only(only(segment.value, "1654ae6b").value, "ae").value;
  assert.equal(only(track, "86").value.toString(), "V_VP8");
  assert.deepEqual(
    ["b0", "ba"].map((id) => numberIn(only(only(track, "e0").value, id))),
    [640, 361],
  );

  const clusters = segment.value.filter(({ id }) => id === "1f43b675");
  const cues = only(segment.value, "1c53bb6b").value.map(({ value }) => ({
    time: numberIn(only(value, "b3")),
    place: numberIn(only(only(value, "b7").value, "f1")),
  }));
  assert.deepEqual(
    cues,
    clusters.map(({ at, value }) => ({ time: numberIn(only(value, "e7")), place: at - segment.begin })),
  );
  const read = clusters.flatMap(({ value }) =>
    value
      .filter(({ id }) => id === "a3")
      .map(({ value: block }) => ({
        data: Uint8Array.from(block.subarray(4)),
        time: numberIn(only(value, "e7")) + block.readInt16BE(1),
        isKey: block[3] === 0x80,
      })),
  );
  assert.deepEqual(read, pictures);
});
