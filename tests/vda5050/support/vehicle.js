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
    ON_CANCEL: {},
    RUNNING: { durationTime: ["duration", 0], next: "FINISHED" },
    FINISHED: { resultDescription: () => "" },
    FAILED: {},
  },
});

class RecordingVehicle extends vda.VirtualAgvAdapter {
  get actionDefinitions() {
    return [...super.actionDefinitions, timed("fleetplanService"), timed("fleetplanWait")];
  }

  attach(context) {
    super.attach(context);
    this.record();
  }

  _onTick(...time) {
    super._onTick(...time);
    this.record();
  }

  record() {
    const { x, y } = this.vehicleState.position;
    this.options.track.push([performance.now(), x, y]);
  }
}

/**
 * A vehicle that stands in `start`: {track, stop}. `track` gets [ms, x, y] whenever the vehicle has moved on; between
 * two of them it drives straight. `nextFactor` returns the share of its speed that it drives on an edge.
 */
export async function startVehicle({ broker, interfaceName, id, mapId, start, speed, timeLapse, nextFactor }) {
  const track = [];
  const controller = new vda.AgvController(
    id,
    { interfaceName, transport: { brokerUrl: broker }, vdaVersion: "2.0.0" },
    { agvAdapterType: RecordingVehicle },
    {
      initialPosition: { mapId, x: start.x, y: start.y, theta: start.theta, lastNodeId: "start" },
      vehicleSpeedDistribution: () => [speed * nextFactor(), speed],
      agvNormalDeviationXyTolerance: 1e-6,
      agvNormalDeviationThetaTolerance: 1e-6,
      tickRate: 50,
      timeLapse,
      track,
    },
  );
  await controller.start();
  return { track, stop: () => controller.stop() };
}
