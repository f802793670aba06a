// Where in a request an error is, by its JSON Pointer (RFC 6901). Pure.

/** The parts of a pointer, unescaped. */
export function partsOf(pointer) {
  return pointer
    .split("/")
    .slice(1)
    .map((part) => part.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** The index of the robot that a pointer leads to or into, or null. */
export function robotIndexOf(pointer) {
  const [first, index] = partsOf(pointer);
  return first === "robots" && /^\d+$/.test(index ?? "") ? Number(index) : null;
}

/** The row of the map that a pointer leads to, 0 the top one, or null. */
export function mapRowOf(pointer) {
  const [first, rows, row] = partsOf(pointer);
  return first === "map" && rows === "rows" && /^\d+$/.test(row ?? "") ? Number(row) : null;
}
