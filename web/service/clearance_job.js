// Works clearance curves out in a worker. Only what was asked last is answered.

const WORKER = new URL("../model/clearance_worker.js", import.meta.url);

/**
 * A function (motions, told) that calls `told` with clearanceOf the motions, unless it is called again before.
 */
export function clearanceJob() {
  let worker = null;
  let busy = false;
  return (motions, told) => {
    if (busy) worker.terminate();
    if (busy || worker === null) worker = new Worker(WORKER, { type: "module" });
    busy = true;
    worker.onmessage = ({ data }) => {
      busy = false;
      told(data);
    };
    worker.postMessage(motions);
  };
}
