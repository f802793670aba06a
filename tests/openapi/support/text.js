// JSON text, including what JSON.stringify cannot write: huge integers, repeated keys, malformed values.

/** Text that is written unchanged in place of a value. */
export class Raw {
  constructor(text) {
    this.text = text;
  }
}

/** An object by its pairs of key and value, in which keys may repeat. */
export class Members {
  constructor(pairs) {
    this.pairs = pairs;
  }
}

/** The text of a value of JSON's types, BigInt, Raw and Members. */
export function textOf(value) {
  if (value instanceof Raw) return value.text;
  if (typeof value === "bigint") return String(value);
  if (Object.is(value, -0)) return "-0.0";
  if (Array.isArray(value)) return `[${value.map(textOf).join(",")}]`;
  if (value === null || typeof value !== "object") return JSON.stringify(value);
  const pairs = value instanceof Members ? value.pairs : Object.entries(value);
  return `{${pairs.map(([key, member]) => `${JSON.stringify(key)}:${textOf(member)}`).join(",")}}`;
}

/** The value of a text and how deep it nests; undefined if it is not JSON in UTF-8 or has half of a surrogate pair. */
export function parsed(bytes) {
  try {
    const value = JSON.parse(new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes));
    const { depth, whole } = inspected(value);
    return whole ? { value, depth } : undefined;
  } catch {
    return undefined;
  }
}

/** How deep a value nests, and whether its strings and keys have no half of a surrogate pair. */
function inspected(value) {
  if (typeof value === "string") return { depth: 0, whole: !/\p{Surrogate}/u.test(value) };
  if (value === null || typeof value !== "object") return { depth: 0, whole: true };
  const parts = Object.entries(value).map(([key, member]) => {
    const { depth, whole } = inspected(member);
    return { depth, whole: whole && inspected(key).whole };
  });
  return {
    depth: 1 + Math.max(0, ...parts.map(({ depth }) => depth)),
    whole: parts.every(({ whole }) => whole),
  };
}
