#!/usr/bin/env node
// Plans a request and drives vehicles over MQTT along the plan; see README.md.
//
//   node main.js --service http://localhost:8080 --broker mqtt://localhost:1883 --manufacturer acme request.json

import { readFileSync } from "node:fs";
import { parseArgs } from "node:util";
import vda from "vda-5050-lib";

import { Bridge, post } from "./bridge.js";

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    service: { type: "string", default: "http://localhost:8080" },
    broker: { type: "string", default: "mqtt://localhost:1883" },
    interface: { type: "string", default: "fleetplan" },
    manufacturer: { type: "string", default: "fleetplan" },
    map: { type: "string", default: "map" },
  },
});
if (positionals.length !== 1) {
  console.error("Usage: main.js [--service URL] [--broker URL] [--interface NAME] [--manufacturer NAME] [--map ID] FILE");
  process.exit(2);
}

const request = JSON.parse(readFileSync(positionals[0], "utf8"));
request.options = { interval_margin: 0.5, ...request.options, dependencies: true };
const answer = await post(values.service, "/v1/plan", request);
if (answer.unplanned.length > 0) console.warn(`without a plan: ${answer.unplanned.map(({ robot }) => robot).join(", ")}`);
if (answer.tight.length > 0) console.warn(`${answer.tight.length} pairs have to keep the clock: plan with more margin`);

const client = new vda.MasterControlClient({
  interfaceName: values.interface,
  transport: { brokerUrl: values.broker },
  vdaVersion: "2.0.0",
});
await client.start();
const bridge = new Bridge({
  service: values.service,
  client,
  request,
  answer,
  manufacturer: values.manufacturer,
  mapId: values.map,
});
await bridge.run();
console.log(`${answer.plans.length} vehicles have arrived, after ${bridge.updates} order updates`);
await client.stop();
