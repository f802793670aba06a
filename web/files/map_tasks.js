// The work of map_work.js, done in a worker that is started when it is needed first.

import { FileError } from "../model/problem.js";

const WORKER = new URL("map_worker.js", import.meta.url);
const NAMES = ["readMask", "readMovingAiMap", "readRequestMap", "requestMapOf", "readRosImage", "mergeCells"];
const NOT_READ =
  "The page cannot read maps, as a part of it is missing. Is the service reachable? Reload the page to try again.";

/** The functions of MAP_WORK, which resolve to their results. They reject with FileError if the worker fails. */
export function mapTasks() {
  const tasks = new MapTasks();
  return Object.fromEntries(NAMES.map((name) => [name, (...args) => tasks.run(name, args)]));
}

class MapTasks {
  /** @type {Worker | null} */
  #worker = null;
  #pending = new Map(); // id -> {resolve, reject}
  #last = 0; // id

  run(name, args) {
    const worker = (this.#worker ??= this.#start());
    const id = (this.#last += 1);
    return new Promise((resolve, reject) => {
      this.#pending.set(id, { resolve, reject });
      worker.postMessage({ id, name, args });
    });
  }

  #start() {
    const worker = new Worker(WORKER, { type: "module" });
    worker.onmessage = ({ data: { id, result, fault, isOfFile } }) => {
      const { resolve, reject } = this.#pending.get(id);
      this.#pending.delete(id);
      if (fault === undefined) resolve(result);
      else reject(isOfFile ? new FileError(fault) : new Error(fault));
    };
    worker.onerror = () => {
      this.#worker = null;
      for (const { reject } of this.#pending.values()) reject(new FileError(NOT_READ));
      this.#pending.clear();
    };
    return worker;
  }
}
