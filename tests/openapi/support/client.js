// Sends requests, as raw bytes where needed, and compares the answers with the document.

import assert from "node:assert/strict";
import { Agent, request } from "node:http";
import { connect } from "node:net";

const TIMEOUT_MS = 30_000;
/** Header fields with a meaning for programs. They must be documented where they are sent. */
const CONTROL_FIELDS = ["allow", "retry-after", "www-authenticate", "accept-encoding"];

/** A client of the service at `url`. An answer that the document does not describe fails an assertion. */
export class Client {
  #agent = new Agent({ keepAlive: true });
  #url;
  #document;

  constructor(url, document) {
    this.#url = new URL(url);
    this.#document = document;
  }

  /** {method, path, status, headers, body, json, took_ms}. */
  async send(method, path, { body, headers = {} } = {}) {
    const sent = await this.#exchange(method, path, body, headers);
    return checked(this.#document, { method, path, ...sent });
  }

  post(path, body, headers = {}) {
    const bytes = typeof body === "string" || body instanceof Uint8Array ? body : JSON.stringify(body);
    return this.send("POST", path, {
      body: bytes,
      headers: { "Content-Type": "application/json", ...headers },
    });
  }

  get(path, headers = {}) {
    return this.send("GET", path, { headers });
  }

  /** Sends these bytes on a separate connection and reads until the server closes it. */
  async sendRaw(method, path, text) {
    const { hostname, port } = this.#url;
    const socket = connect({ host: hostname, port: Number(port) });
    socket.setTimeout(TIMEOUT_MS, () => socket.destroy(new Error("no answer in time")));
    socket.write(text);
    const parts = [];
    for await (const part of socket) parts.push(part);
    const whole = Buffer.concat(parts).toString("utf8");
    const end = whole.indexOf("\r\n\r\n");
    const [line, ...fields] = whole.slice(0, end).split("\r\n");
    const headers = {};
    for (const field of fields) {
      const [name, value] = field.split(/: (.*)/);
      headers[name.toLowerCase()] = value;
    }
    const body = whole.slice(end + 4);
    return checked(this.#document, { method, path, status: Number(line.split(" ")[1]), headers, body });
  }

  close() {
    this.#agent.destroy();
  }

  #exchange(method, path, body, headers) {
    const began = performance.now();
    return new Promise((resolve, reject) => {
      const { hostname: host, port } = this.#url;
      const length = body === undefined ? {} : { "Content-Length": Buffer.byteLength(body) };
      const options = { host, port, method, path, agent: this.#agent, headers: { ...length, ...headers } };
      const sent = request(options, async (answer) => {
        try {
          const parts = [];
          for await (const part of answer) parts.push(part);
          const text = Buffer.concat(parts).toString("utf8");
          const took_ms = performance.now() - began;
          resolve({ status: answer.statusCode, headers: answer.headers, body: text, took_ms });
        } catch (error) {
          reject(error);
        }
      });
      sent.setTimeout(TIMEOUT_MS, () => sent.destroy(new Error("no answer in time")));
      sent.on("error", reject);
      sent.end(body);
    });
  }
}

/** The events of a stream, [{event, data}], each checked against the document's schema of its kind. */
function checkedEvents(document, media, answer) {
  const blocks = answer.body.split("\n\n");
  assert.equal(blocks.pop(), "", "the last event ends with an empty line");
  const withoutComments = blocks.map((block) => block.replaceAll(/^:.*\n?/gm, ""));
  return withoutComments.filter(Boolean).map((block) => {
    const [, event, text] =
      /^event: (\w+)\ndata: ([^\r\n]*)$/.exec(block) ?? assert.fail(`not an event: ${block}`);
    const data = JSON.parse(text);
    assert.deepEqual(
      document.faultsOf([...media.steps, "schema", "contentSchema", "items"], { event, data }),
      [],
    );
    if (data.request_id !== undefined) assert.equal(data.request_id, answer.headers["x-request-id"]);
    return { event, data };
  });
}

function checked(document, answer) {
  const { method, path, status, headers } = answer;
  const exchange = `${method} ${path} answered ${status}: ${answer.body.slice(0, 400)}`;
  const documented = document.responseTo(method, path, status);
  assert.ok(documented, `not documented: ${exchange}`);

  const header = (name) => document.at([...documented.steps, "headers", name]);
  for (const name of Object.keys(documented.value.headers)) {
    const value = headers[name.toLowerCase()];
    const documentedHeader = header(name);
    if (value === undefined) {
      assert.ok(!documentedHeader.value.required, `no ${name}: ${exchange}`);
    } else {
      assert.deepEqual(
        document.faultsOf([...documentedHeader.steps, "schema"], value),
        [],
        `${name} of ${exchange}`,
      );
    }
  }
  const names = Object.keys(documented.value.headers).map((name) => name.toLowerCase());
  for (const name of CONTROL_FIELDS)
    assert.ok(!headers[name] || names.includes(name), `${name} is not documented: ${exchange}`);

  const [type] = headers["content-type"].split(";");
  const media = document.at([...documented.steps, "content", type]);
  assert.ok(media.value, `content type ${type} is not documented: ${exchange}`);
  if (method === "HEAD") return answer;
  if (type === "text/event-stream") return { ...answer, events: checkedEvents(document, media, answer) };
  const json = type.endsWith("json") ? JSON.parse(answer.body) : undefined;
  assert.deepEqual(document.faultsOf([...media.steps, "schema"], json ?? answer.body), [], exchange);
  if (status >= 400) assert.equal(json.status, status, exchange);
  if (json?.request_id !== undefined) assert.equal(json.request_id, headers["x-request-id"], exchange);
  return { ...answer, json };
}
