// JSON Pointers (RFC 6901) of faults, and the request that they point into.

/** The steps of a pointer: "/a~1b/0" is ["a/b", "0"]. */
export function stepsOf(pointer) {
  if (pointer === "") return [];
  if (!pointer.startsWith("/")) throw new Error(`not a JSON pointer: ${pointer}`);
  return pointer
    .slice(1)
    .split("/")
    .map((step) => step.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** Whether an own member, or an item by its index, exists. */
function has(container, step) {
  if (Array.isArray(container)) return /^(0|[1-9][0-9]*)$/.test(step) && Number(step) < container.length;
  return container !== null && typeof container === "object" && Object.hasOwn(container, step);
}

/** The value that the steps lead to: {found, value}. */
export function lookUp(document, steps) {
  let value = document;
  for (const step of steps) {
    if (!has(value, step)) return { found: false, value: undefined };
    value = value[step];
  }
  return { found: true, value };
}

/** Why a fault's pointer is wrong, or undefined if it points at a value or at the place of a missing member. */
export function misplaced(fault, request) {
  const steps = stepsOf(fault.pointer);
  if (fault.code !== "missing") {
    return lookUp(request, steps).found ? undefined : `${fault.pointer} does not exist (${fault.detail})`;
  }
  const outer = lookUp(request, steps.slice(0, -1));
  const isObject = outer.found && outer.value !== null && typeof outer.value === "object";
  if (!isObject || Array.isArray(outer.value))
    return `${fault.pointer} is not in an object (${fault.detail})`;
  return has(outer.value, steps.at(-1)) ? `${fault.pointer} is not missing` : undefined;
}
