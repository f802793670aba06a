// Values generated from the schemas of the document.

import fc from "fast-check";

export const LARGEST_LIST = 4;

/** Numbers of the schema's range: with few digits, arbitrary ones, and the ends of the range. */
function numbers(schema) {
  const least = schema.minimum ?? -Number.MAX_VALUE;
  const most = schema.maximum ?? Number.MAX_VALUE;
  const inside = (value) => Math.min(Math.max(value, least), most);
  return fc.oneof(
    { weight: 4, arbitrary: fc.integer({ min: -100, max: 100 }).map((value) => inside(value / 4)) },
    { weight: 1, arbitrary: fc.double({ min: least, max: most, noNaN: true }) },
    { weight: 1, arbitrary: fc.constantFrom(least, most, inside(0)) },
  );
}

/** Whole numbers as BigInt, because JavaScript's numbers cannot represent the ends of the ranges. */
function integers(schema) {
  const whole = (value) =>
    value === 18446744073709551615 ? 2n ** 64n - 1n : value === 2 ** 63 ? 2n ** 63n - 1n : BigInt(value);
  const least = whole(schema.minimum);
  const most = whole(schema.maximum);
  return fc.oneof(
    fc.bigInt({ min: least, max: least > 0n ? least + 20n : 20n }),
    fc.bigInt({ min: least, max: most }),
    fc.constantFrom(least, most),
  );
}

function objects(document, schema, overrides) {
  const members = Object.entries(schema.properties ?? {}).map(([key, member]) => [
    key,
    valuesOf(document, member, overrides),
  ]);
  return fc.record(Object.fromEntries(members), {
    requiredKeys: schema.required ?? [],
    noNullPrototype: true,
  });
}

function valuesOfType(document, schema, type, overrides) {
  switch (type) {
    case "null":
      return fc.constant(null);
    case "boolean":
      return fc.boolean();
    case "integer":
      return integers(schema);
    case "number":
      return numbers(schema);
    case "string":
      if (schema.pattern) return fc.stringMatching(new RegExp(schema.pattern));
      return fc.string({ minLength: schema.minLength ?? 0, maxLength: 12, unit: "grapheme" });
    case "array":
      if (schema.prefixItems)
        return fc.tuple(...schema.prefixItems.map((item) => valuesOf(document, item, overrides)));
      return fc.array(valuesOf(document, schema.items, overrides), {
        minLength: schema.minItems ?? 0,
        maxLength: LARGEST_LIST,
      });
    case "object":
      return objects(document, schema, overrides);
    default:
      throw new Error(`cannot generate values of type ${type}`);
  }
}

/**
 * Values that fit a schema of the document, without its conditions (`allOf`). `overrides` replaces the arbitraries of
 * components, by name.
 */
export function valuesOf(document, schema, overrides = {}) {
  if (schema.$ref !== undefined) {
    const name = schema.$ref.split("/").at(-1);
    return overrides[name] ?? valuesOf(document, document.root.components.schemas[name], overrides);
  }
  if (schema.enum !== undefined) return fc.constantFrom(...schema.enum);
  if (schema.const !== undefined) return fc.constant(schema.const);
  if (schema.type === undefined && schema.oneOf !== undefined)
    return fc.oneof(...schema.oneOf.map((one) => valuesOf(document, one, overrides)));
  if (schema.type === undefined) return fc.jsonValue({ maxDepth: 3 });
  const types = [schema.type].flat();
  return fc.oneof(...types.map((type) => valuesOfType(document, schema, type, overrides)));
}

/** Values of a component's schema. */
export function valuesOfComponent(document, name, overrides = {}) {
  return valuesOf(document, document.root.components.schemas[name], overrides);
}

export const mostly = (usual, any) =>
  fc.oneof({ weight: 7, arbitrary: usual }, { weight: 1, arbitrary: any });

/** Numbers of a range, all of it as likely; doubles by their bits are mostly tiny. */
export function within(least, most) {
  const STEPS = 2 ** 20;
  return fc.integer({ min: 0, max: STEPS }).map((step) => least + (most - least) * (step / STEPS));
}
