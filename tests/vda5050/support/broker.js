// An MQTT broker, Debian's mosquitto, on a free port of 127.0.0.1.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { freePorts } from "../../web/support/free_ports.js";

const START_MS = 20_000;

/** {url, stop} */
export async function startBroker() {
  const [port] = await freePorts(1);
  const folder = mkdtempSync(join(tmpdir(), "broker-"));
  const file = join(folder, "mosquitto.conf");
  writeFileSync(file, `listener ${port} 127.0.0.1\nallow_anonymous true\npersistence false\n`);
  const env = { ...process.env, PATH: `${process.env.PATH}:/usr/sbin` };
  const child = spawn("mosquitto", ["-c", file], { env, stdio: ["ignore", "ignore", "pipe"] });
  let log = "";
  child.stderr.on("data", (data) => (log += data));
  const ended = once(child, "exit");
  const stop = async () => {
    child.kill("SIGTERM");
    await ended;
    rmSync(folder, { recursive: true });
  };
  const began = Date.now();
  while (!(await accepts(port))) {
    if (child.exitCode !== null || Date.now() > began + START_MS) {
      await stop();
      throw new Error(`the broker did not start: ${log}`);
    }
  }
  return { url: `mqtt://127.0.0.1:${port}`, stop };
}

async function accepts(port) {
  const socket = connect(port, "127.0.0.1");
  try {
    await once(socket, "connect");
    return true;
  } catch {
    await new Promise((resolve) => setTimeout(resolve, 50));
    return false;
  } finally {
    socket.destroy();
  }
}
