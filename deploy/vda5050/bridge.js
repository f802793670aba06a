// Drives vehicles that speak VDA 5050 along a plan with dependencies: it publishes their orders, follows their states,
// and releases more of the orders as vehicles make progress. It keeps nothing that the messages do not tell.

/** Members that a client of VDA 5050 fills in itself. */
const HEADER = ["headerId", "timestamp", "version", "manufacturer", "serialNumber"];

/** The members of the request that the export needs. */
const EXPORTED = ["map", "robots", "robot_defaults", "options"];

/**
 * The answer of the service to a body. Requests have no effects, so one that fails with its connection is repeated
 * once: the service may just have closed a connection that was idle.
 */
export async function post(service, path, body) {
  const request = {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  };
  const url = new URL(path, service);
  const response = await fetch(url, request).catch(() => fetch(url, request));
  if (!response.ok) throw new Error(`${response.status} ${await response.text()}`);
  return response.json();
}

export class Bridge {
  /**
   * - service: address of Fleetplan, such as http://localhost:8080
   * - client: a started MasterControlClient of vda-5050-lib, or anything with its publish and subscribe
   * - request: the request that was planned
   * - answer: its answer, with `plans` and `dependencies`
   * - manufacturer, and serialNumbers ({robot: serial number}; by default the robots' ids)
   * - mapId: the name of the map that the vehicles know
   */
  constructor({ service, client, request, answer, manufacturer, serialNumbers = {}, mapId = "map" }) {
    this.service = service;
    this.client = client;
    this.manufacturer = manufacturer;
    this.body = { version: "2.1.0", manufacturer, serial_numbers: serialNumbers, map_id: mapId };
    for (const member of EXPORTED) if (member in request) this.body[member] = request[member];
    this.body.plans = answer.plans;
    this.body.dependencies = answer.dependencies;
    this.body.timestamp = new Date().toISOString();
    this.vehicles = new Map(); // by serial number
    this.updates = 0;
    this.pending = false;
    this.changed = false;
  }

  /** Resolves when all vehicles have arrived, or rejects with the first error. */
  run() {
    return new Promise((resolve, reject) => {
      this.resolve = resolve;
      this.reject = reject;
      this.client
        .subscribe("state", { manufacturer: this.manufacturer }, (state) => this.take(state))
        .then(() => this.release())
        .catch(reject);
    });
  }

  /** A vehicle reports. */
  take(state) {
    const vehicle = this.vehicles.get(state.serialNumber);
    if (!vehicle || state.orderId !== vehicle.orderId) return;
    const fatal = state.errors.find((error) => error.errorType.endsWith("Error"));
    if (fatal) {
      this.reject(new Error(`${state.serialNumber}: ${fatal.errorType} ${JSON.stringify(fatal)}`));
      return;
    }
    if (state.lastNodeSequenceId > vehicle.reached) {
      vehicle.reached = state.lastNodeSequenceId;
      this.changed = true;
    }
    const isBusy = ({ actionStatus }) => actionStatus !== "FINISHED" && actionStatus !== "FAILED";
    vehicle.arrived = vehicle.reached === vehicle.last && !state.actionStates.some(isBusy);
    if ([...this.vehicles.values()].every(({ arrived }) => arrived)) this.resolve();
    else if (this.changed) this.release().catch(this.reject);
  }

  /** Publishes what the progress of all vehicles releases. One export at a time. */
  async release() {
    if (this.pending) return;
    this.pending = true;
    try {
      do {
        this.changed = false;
        const { orders } = await this.export();
        for (const order of orders) await this.publish(order);
      } while (this.changed);
    } finally {
      this.pending = false;
    }
    if (this.vehicles.size === 0) this.resolve(); // nobody has to move
  }

  async export() {
    const progress = [...this.vehicles.values()].map((vehicle) => ({
      robot: vehicle.robot,
      order_id: vehicle.orderId,
      order_update_id: vehicle.updateId,
      last_released_sequence_id: vehicle.released,
      ...vehicle.nodes.get(vehicle.reached),
    }));
    return post(this.service, "/v1/export/vda5050", { ...this.body, progress });
  }

  async publish({ robot, order, last_released_sequence_id: released, nodes }) {
    const known = this.vehicles.get(order.serialNumber);
    const vehicle = known ?? { robot, orderId: order.orderId, reached: 0, nodes: new Map() };
    vehicle.updateId = order.orderUpdateId;
    vehicle.released = released;
    for (const { sequence_id, action, progress } of nodes) vehicle.nodes.set(sequence_id, { action, progress });
    vehicle.last = Math.max(...vehicle.nodes.keys());
    this.vehicles.set(order.serialNumber, vehicle);
    this.updates += known ? 1 : 0;
    const headerless = Object.fromEntries(Object.entries(order).filter(([member]) => !HEADER.includes(member)));
    const vehicleId = { manufacturer: this.manufacturer, serialNumber: order.serialNumber };
    await this.client.publish("order", vehicleId, headerless);
  }
}
