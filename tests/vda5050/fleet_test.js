// A foreign client's vehicles drive the plan of the warehouse over MQTT. The client is vda-5050-lib, which speaks VDA
// 5050 up to 2.0 and judges every message by this version's schema.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import vda from "vda-5050-lib";

import { Bridge, post } from "../../deploy/vda5050/bridge.js";
import { startService } from "../web/support/service.js";
import { startBroker } from "./support/broker.js";
import { generator } from "./support/random.js";
import { leastGapOfAll } from "./support/replay.js";
import { startVehicle } from "./support/vehicle.js";

const MANUFACTURER = "fleetplan";
const TOLERANCE = 2e-6; // metres: the tolerance of plans and dependencies, and rounding
const TIME_LAPSE = 20;
const LONGEST_MS = 180_000;

let service, broker;
before(async () => ([service, broker] = await Promise.all([startService(), startBroker()])));
after(() => Promise.all([service.stop(), broker.stop()]));

async function planned() {
  const file = new URL("../scenarios/warehouse.json", import.meta.url);
  const request = JSON.parse(readFileSync(file, "utf8"));
  request.options = { interval_margin: 0.5, dependencies: true };
  const answer = await post(service.url, "/v1/plan", request);
  assert.equal(answer.status, "solved");
  assert.deepEqual(answer.tight, []);
  return { request, answer };
}

/** Lets virtual vehicles drive: {tracks by robot, updates}. */
async function drive({ request, answer }, interfaceName) {
  const random = generator(7);
  const speedOf = (robot) => robot.linear_speed ?? request.robot_defaults.linear_speed;
  const vehicles = await Promise.all(
    request.robots.map((robot) =>
      startVehicle({
        broker: broker.url,
        interfaceName,
        id: { manufacturer: MANUFACTURER, serialNumber: robot.id },
        mapId: "hall",
        start: { theta: 0, ...robot.start },
        speed: speedOf(robot),
        timeLapse: TIME_LAPSE,
        nextFactor: () => (random() < 0.2 ? 0.2 : 0.5 + 0.5 * random()),
      }),
    ),
  );
  const client = new vda.MasterControlClient({
    interfaceName,
    transport: { brokerUrl: broker.url },
    vdaVersion: "2.0.0",
  });
  await client.start();
  let late;
  try {
    const bridge = new Bridge({
      service: service.url,
      client,
      request,
      answer,
      manufacturer: MANUFACTURER,
      mapId: "hall",
    });
    const timeout = new Promise((_, reject) => {
      late = setTimeout(() => reject(new Error("not all vehicles have arrived in time")), LONGEST_MS);
    });
    await Promise.race([bridge.run(), timeout]);
    return { tracks: vehicles.map(({ track }) => track), updates: bridge.updates };
  } finally {
    clearTimeout(late);
    await Promise.all(vehicles.map((vehicle) => vehicle.stop()));
    await client.stop();
  }
}

function gapOf(tracks, request) {
  const radiusOf = (robot) => robot.radius ?? request.robot_defaults.radius;
  return leastGapOfAll(tracks, request.robots.map(radiusOf));
}

test("vehicles with random speeds arrive and never touch", async () => {
  const { request, answer } = await planned();
  const { tracks, updates } = await drive({ request, answer }, "with");
  for (const { robot, actions } of answer.plans) {
    if (actions.length === 0) continue;
    const index = request.robots.findIndex(({ id }) => id === robot);
    const [, x, y] = tracks[index].at(-1);
    const { to } = actions.at(-1);
    assert.ok(Math.hypot(x - to.x, y - to.y) < 1e-6, `${robot} has not arrived`);
  }
  assert.ok(updates > answer.plans.length, "hardly any order was updated");
  const gap = gapOf(tracks, request);
  assert.ok(gap >= -TOLERANCE, `two vehicles overlap by ${-gap} m`);
});

test("without dependencies the same vehicles collide", async () => {
  const { request, answer } = await planned();
  const { tracks } = await drive({ request, answer: { ...answer, dependencies: [] } }, "without");
  assert.ok(gapOf(tracks, request) < -TOLERANCE, "the test above would not notice a collision");
});
