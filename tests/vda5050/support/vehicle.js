// A virtual vehicle of vda-5050-lib that knows the actions of exported orders, drives at random speeds, and records
// where it is.

import vda from "vda-5050-lib";

/** The actions of orders that Fleetplan exports: they take their `duration`. */
const timed = (actionType) => ({
  actionType,
  actionScopes: "node",
  actionParameterConstraints: { duration: (value) => typeof value === "number" },
  transitions: {
    ON_INIT: { next: "RUNNING" },
    ON_CANCEL: { next: "FAILED" },
    RUNNING: { durationTime: ["duration", 0], next: "FINISHED" },
    FINISHED: { resultDescription: () => "" },
    FAILED: { errorDescription: () => "" },
  },
});

const MOTOR_ERROR = {
  errorType: "motorError",
  errorLevel: "FATAL",
  errorDescription: "stuck",
  errorReferences: [],
};

class RecordingVehicle extends vda.VirtualAgvAdapter {
  get actionDefinitions() {
    return [...super.actionDefinitions, timed("fleetplanService"), timed("fleetplanWait")];
  }

  attach(context) {
    super.attach(context);
    this.record();
  }

  /** It stops for good when it drives the next time. */
  fail() {
    this.isFailing = true;
  }

  _onTick(...time) {
    super._onTick(...time);
    this.record();
  }

  _advanceTraverse(...time) {
    const edge = this._traverseContext;
    if (edge && this.isFailing) return this.controller.updateErrors(MOTOR_ERROR, "add", true);
    super._advanceTraverse(...time);
    if (!edge || this._traverseContext !== edge) return;
    // The library takes the orientation of an edge as relative to the map, although it is tangential.
    const { x, y } = edge.endNode.nodePosition;
    const ahead = Math.atan2(y - this.vehicleState.position.y, x - this.vehicleState.position.x);
    this.vehicleState.position.theta = ahead + (edge.edge.orientation ?? 0);
  }

  record() {
    const { x, y } = this.vehicleState.position;
    this.options.track.push([performance.now(), x, y]);
  }
}

class Controller extends vda.AgvController {
  refused = [];

  /**
   * The actions of the node at which an update begins are known already. From VDA 5050 2.1 on, they are sent again. The
   * library, which speaks 2.0, would execute them again.
   */
  _acceptOrder(order, mode) {
    if (mode === "new") return super._acceptOrder(order, mode);
    const [first, ...others] = order.nodes;
    super._acceptOrder({ ...order, nodes: [{ ...first, actions: [] }, ...others] }, mode);
  }

  /** An error of the motor does not end with an order. */
  _getNonOrderRejectionErrors(...how) {
    const motor = this._currentState.errors.filter(({ errorType }) => errorType === MOTOR_ERROR.errorType);
    return [...super._getNonOrderRejectionErrors(...how), ...motor];
  }

  _rejectOrder(error) {
    this.refused.push(error);
    super._rejectOrder(error);
  }
}

/**
 * A vehicle that stands in `start`: {track, refused, fail, stop}. `track` gets [ms, x, y] whenever the vehicle has moved
 * on; between two of them it drives straight. `refused` gets the errors of orders that it has refused. `nextFactor`
 * returns the share of its speed that it drives on an edge. It reports every `reportMs`.
 */
export async function startVehicle({ broker, interfaceName, id, mapId, start, speed, timeLapse, nextFactor, reportMs }) {
  const track = [];
  const controller = new Controller(
    id,
    { interfaceName, transport: { brokerUrl: broker }, vdaVersion: "2.0.0" },
    { agvAdapterType: RecordingVehicle, ...(reportMs ? { publishStateInterval: reportMs } : {}) },
    {
      initialPosition: { mapId, x: start.x, y: start.y, theta: start.theta, lastNodeId: "start" },
      vehicleSpeedDistribution: () => [speed * nextFactor(), speed],
      agvNormalDeviationXyTolerance: 1e-6,
      agvNormalDeviationThetaTolerance: 7, // it turns on the spot
      batteryMaxReach: 1e9,
      tickRate: 50,
      timeLapse,
      track,
    },
  );
  await controller.start();
  return {
    track,
    refused: controller.refused,
    fail: () => controller._agvAdapter.fail(),
    stop: () => controller.stop(),
  };
}
