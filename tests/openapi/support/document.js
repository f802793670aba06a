// The OpenAPI document of a running service, and the schemas of its answers and requests.

import Ajv2020 from "ajv/dist/2020.js";
import addFormats from "ajv-formats";

const METHODS = ["get", "post"];

/** The document of the service at `url`. */
export async function fetchDocument(url) {
  const answer = await fetch(new URL("/v1/openapi.json", url));
  if (answer.status !== 200) throw new Error(`no document: ${answer.status} ${await answer.text()}`);
  return answer.json();
}

/** A copy in which objects allow only documented members; the schemas of answers allow more, for later versions. */
function closed(schema) {
  if (Array.isArray(schema)) return schema.map(closed);
  if (schema === null || typeof schema !== "object") return schema;
  const copy = Object.fromEntries(Object.entries(schema).map(([key, value]) => [key, closed(value)]));
  const open = schema.type === "object" && schema.properties && schema.additionalProperties === undefined;
  return open ? { ...copy, additionalProperties: false } : copy;
}

export class Document {
  // Conditions need no types: the schema itself rejects other types.
  #ajv = new Ajv2020({ allErrors: true, allowUnionTypes: true, strictTypes: false });
  #validators = new Map();

  constructor(root) {
    this.root = root;
    addFormats(this.#ajv);
    this.#ajv.addVocabulary(Object.keys(root)); // members of the document, not keywords of schemas
    this.#ajv.addVocabulary(["x-unit", "x-enumDescriptions"]);
    this.#ajv.addSchema(closed(root), "document");
  }

  /** The value at these steps below the root, and the steps to it with references followed. */
  at(steps) {
    let value = this.root;
    let place = [];
    for (const step of steps) {
      value = value?.[step];
      place.push(step);
      while (value?.$ref !== undefined) {
        place = value.$ref.slice(2).split("/");
        value = place.reduce((outer, inner) => outer[inner], this.root);
      }
    }
    return { value, steps: place };
  }

  /** How a value violates the schema at these steps; [] if it does not. */
  faultsOf(steps, value) {
    const pointer = steps.map((step) => "/" + step.replaceAll("~", "~0").replaceAll("/", "~1")).join("");
    if (!this.#validators.has(pointer)) {
      this.#validators.set(pointer, this.#ajv.compile({ $ref: `document#${encodeURI(pointer)}` }));
    }
    const validate = this.#validators.get(pointer);
    return validate(value) ? [] : validate.errors.map((error) => `${error.instancePath} ${error.message}`);
  }

  /** How a value violates a component's schema. */
  faultsOfComponent(name, value) {
    return this.faultsOf(["components", "schemas", name], value);
  }

  /** The path template of the document that matches a request's target, or undefined. */
  pathOf(target) {
    const path = target.split("?")[0];
    return Object.keys(this.root.paths).find((template) =>
      new RegExp(`^${template.replaceAll(".", "\\.").replaceAll(/\{\w+\}/g, "[^/]+")}$`).test(path),
    );
  }

  /**
   * The answer that is documented for this request and status, {value, steps}, or undefined. An unknown path has the
   * answer of the component NotFound. An unknown method has the answers of the path's other methods.
   */
  responseTo(method, target, status) {
    const path = this.pathOf(target);
    if (path === undefined) {
      return status === 404 ? this.at(["components", "responses", "NotFound"]) : undefined;
    }
    const requested = method === "HEAD" ? "get" : method.toLowerCase();
    const methods = this.root.paths[path][requested] ? [requested] : METHODS;
    return methods
      .map((one) => this.at(["paths", path, one, "responses", String(status)]))
      .find(({ value }) => value !== undefined);
  }

  /** The examples of all problems. */
  problems() {
    const responses = Object.values(this.root.components.responses);
    const examples = responses.flatMap(({ content }) =>
      Object.values(content["application/problem+json"].examples),
    );
    return examples.map(({ value }) => value);
  }

  /** The codes of all problems, each with the status of its answer. */
  problemCodes() {
    return new Map(this.problems().map(({ code, status }) => [code, status]));
  }
}
