// The real server, started for a test run on a free port of 127.0.0.1 and stopped by its pid.

import { spawn } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { createInterface } from "node:readline";

import { freePorts } from "./free_ports.js";

const START_MS = 60_000;
// After which idle connections are closed: by default so soon that a busy machine's browser may just be sending.
const IDLE_MS = 60_000;

/** Starts the server that FLEETPLAN_BIN names, with the page that was built with it: {url, pid, stop, kill}. */
export async function startService(flags = []) {
  const binary = process.env.FLEETPLAN_BIN;
  if (!binary) throw new Error("FLEETPLAN_BIN must name the server binary");
  const [port] = await freePorts(1);
  const all = ["--host", "127.0.0.1", "--port", String(port), "--log-level", "warn"];
  all.push("--idle-timeout-ms", String(IDLE_MS), ...flags);
  const env = { ...process.env, FLEETPLAN_BIN: undefined }; // which the server would warn of
  const child = spawn(binary, all, { env, stdio: ["ignore", "pipe", "inherit"] });
  const end = { wanted: false, unwanted: undefined };
  const ended = new Promise((resolve) => child.once("exit", resolve));
  child.once("exit", (code, signal) => {
    if (end.wanted) return;
    end.unwanted = `the server ended by itself: ${signal ?? `exit code ${code}`}`;
    console.error(end.unwanted);
  });
  const stop = async (signal) => {
    if (end.unwanted) throw new Error(end.unwanted);
    end.wanted = true;
    child.kill(signal);
    await ended;
  };
  try {
    const url = await listening(child);
    return { url, pid: child.pid, stop: () => stop("SIGTERM"), kill: () => stop("SIGKILL") };
  } catch (error) {
    end.wanted = true;
    child.kill("SIGKILL");
    throw error;
  }
}

/** How long each thread of a process has waited for a CPU so far, in milliseconds by thread. */
export function cpuWaits(pid) {
  const waits = new Map();
  for (const thread of readdirSync(`/proc/${pid}/task`)) {
    try {
      const [, waited] = readFileSync(`/proc/${pid}/task/${thread}/schedstat`, "utf8").split(" ");
      waits.set(thread, Number(waited) / 1e6);
    } catch {
      // the thread has ended, or the kernel does not tell
    }
  }
  return waits;
}

function listening(child) {
  return new Promise((resolve, reject) => {
    const late = setTimeout(
      () => reject(new Error("the server did not print its address in time")),
      START_MS,
    );
    const fail = (why) => {
      clearTimeout(late);
      reject(new Error(`the server did not start: ${why}`));
    };
    child.once("error", fail);
    child.once("exit", (code, signal) => fail(signal ?? `exit code ${code}`));
    createInterface({ input: child.stdout }).on("line", (line) => {
      const found = /listening on (http:\/\/\S+)/.exec(line);
      if (!found) return;
      clearTimeout(late);
      resolve(new URL("/", found[1]).href);
    });
  });
}
