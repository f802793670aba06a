// A foreign client's vehicles are planned again and again while they drive, by the loop of the Python client over MQTT.
// The client is vda-5050-lib. It judges every message by the schema of VDA 5050 2.0, and every order by the rules for
// continuing an order. One vehicle fails on the way. The order of another is cancelled.
//
// LIVE_VEHICLES (at most 40), LIVE_SECONDS (simulated) and LIVE_LAPSE make it a long day.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";

import { startService } from "../web/support/service.js";
import { startBroker } from "./support/broker.js";
import { generator } from "./support/random.js";
import { leastGapOfAll } from "./support/replay.js";
import { startVehicle } from "./support/vehicle.js";

const VEHICLES = Number(process.env.LIVE_VEHICLES ?? 8);
const SECONDS = Number(process.env.LIVE_SECONDS ?? 120);
const LAPSE = Number(process.env.LIVE_LAPSE ?? 15);
const MANUFACTURER = "fleetplan";
const TOLERANCE = 2e-6; // metres: the tolerance of plans and dependencies, and rounding
const BROKEN = 0;
const CANCELLED = 1;

let service, broker;
before(async () => ([service, broker] = await Promise.all([startService(), startBroker()])));
after(() => Promise.all([service.stop(), broker.stop()]));

function fleet() {
  const file = new URL("../scenarios/warehouse.json", import.meta.url);
  const request = JSON.parse(readFileSync(file, "utf8"));
  return request.robots.slice(0, VEHICLES);
}

function startVehicles(robots) {
  const random = generator(11);
  return Promise.all(
    robots.map(({ id, start, linear_speed }) =>
      startVehicle({
        broker: broker.url,
        interfaceName: "live",
        id: { manufacturer: MANUFACTURER, serialNumber: id },
        mapId: "hall",
        start: { theta: 0, ...start },
        speed: linear_speed,
        timeLapse: LAPSE,
        nextFactor: () => (random() < 0.1 ? 0.3 : 0.7 + 0.3 * random()),
        reportMs: Math.max(20, 2000 / LAPSE),
      }),
    ),
  );
}

/** The loop, in a process of its own: what it has reported at its end. */
async function drive(robots, begun) {
  const values = {
    service: service.url,
    port: new URL(broker.url).port,
    interface: "live",
    manufacturer: MANUFACTURER,
    map: "hall",
    robots: robots.length,
    cancel: robots[CANCELLED].id,
    lapse: LAPSE,
    seconds: SECONDS,
    ahead: Math.max(4, LAPSE / 2),
    period: Math.max(2, LAPSE / 5),
    pause: Math.min(0.1, 0.4 / LAPSE),
  };
  const script = new URL("support/drive.py", import.meta.url).pathname;
  const options = Object.entries(values).flatMap(([name, value]) => [`--${name}`, `${value}`]);
  const child = spawn("/usr/bin/python3", ["-B", script, ...options], {
    stdio: ["ignore", "pipe", "inherit"],
  });
  let printed = "";
  child.stdout.once("data", begun);
  child.stdout.on("data", (data) => (printed += data));
  const [code] = await once(child, "close");
  assert.equal(code, 0);
  return JSON.parse(printed.trim().split("\n").at(-1));
}

test("vehicles are planned again while they drive, and never touch", async (t) => {
  const robots = fleet();
  const vehicles = await startVehicles(robots);
  let day, failing;
  try {
    day = await drive(robots, () => {
      failing = setTimeout(() => vehicles[BROKEN].fail(), (SECONDS / LAPSE / 4) * 1000);
    });
  } finally {
    clearTimeout(failing);
    await Promise.all(vehicles.map((vehicle) => vehicle.stop()));
  }
  t.diagnostic(JSON.stringify(day));
  assert.deepEqual(
    vehicles.flatMap(({ refused }) => refused),
    [],
    "orders were refused",
  );
  assert.deepEqual(day.failures, []);
  assert.deepEqual(day.failed, [robots[BROKEN].id]);
  assert.deepEqual(Object.keys(day.cancelled).sort(), [robots[BROKEN].id, robots[CANCELLED].id].sort());
  assert.ok(day.rounds >= SECONDS / 20, "too few plans");
  assert.ok(day.arrived >= (VEHICLES * SECONDS) / 480, "too few have arrived");
  const radii = robots.map(({ radius }) => radius);
  const gap = leastGapOfAll(
    vehicles.map(({ track }) => track),
    radii,
  );
  t.diagnostic(`the least gap is ${gap} m`);
  assert.ok(gap >= -TOLERANCE, `two vehicles overlap by ${-gap} m`);
});
