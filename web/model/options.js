// The options of a plan, as the service's OpenAPI document describes them, and editing them in a request.
// Pure.

/** @import {Option, Request} from "./types.js" */

/** The options in an OpenAPI document, in its order: the members of the schema PlanOptions. */
export function readOptions(document) {
  const { schemas } = document.components;
  return Object.entries(schemas.PlanOptions.properties).map(([name, schema]) =>
    optionFrom(name, resolved(schema, schemas)),
  );
}

/** A schema with the members of the schema that it refers to, if any. Its own members take precedence. */
function resolved({ $ref, ...schema }, schemas) {
  return $ref === undefined ? schema : { ...schemas[$ref.split("/").at(-1)], ...schema };
}

/** @returns {Option} */
function optionFrom(name, schema) {
  const types = [schema.type].flat();
  const unit = schema["x-unit"] ?? (name.endsWith("_ms") ? "ms" : "");
  const words = schema["x-enumDescriptions"] ?? {};
  return {
    name,
    label: schema.title ?? inWords(name.replace(/_ms$/, "")),
    unit,
    type: types.find((type) => type !== "null"),
    default: schema.default ?? null,
    choices: schema.enum?.map((value) => ({ value, label: words[value] ?? inWords(String(value)) })) ?? null,
    min: schema.minimum ?? null,
    max: schema.maximum <= Number.MAX_SAFE_INTEGER ? schema.maximum : null, // larger ones are no limits
    description: schema.description ?? "",
  };
}

/** An identifier as words: "Shortest first" for shortest_first. */
function inWords(identifier) {
  const words = identifier.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/**
 * The value of an option in a request: its own or the default.
 * @param {Request | null} request
 * @param {Option} option
 */
export function optionOf(request, option) {
  return request?.options?.[option.name] ?? option.default;
}

/**
 * The request with an option set. A default is omitted, and so are options without members.
 * @param {Request} request
 * @param {Option} option
 * @returns {Request}
 */
export function withOption(request, option, value) {
  const options = { ...request.options, [option.name]: value };
  if (value === option.default) delete options[option.name];
  /** @type {Request} */
  const edited = { ...request, options };
  if (Object.keys(options).length === 0) delete edited.options;
  return edited;
}
