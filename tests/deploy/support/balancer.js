// HAProxy with the configuration of deploy/haproxy, on free ports of 127.0.0.1, before replicas that a test plays.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createConnection } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { freePorts } from "../../web/support/free_ports.js";
import { textOf } from "./files.js";

const START_MS = 20_000;
const ENV = { ...process.env, PATH: `${process.env.PATH}:/usr/sbin` };

/** A replica that handles what is not a readiness check: {port, requests, close}. `handle(request, body, response)`. */
export async function startReplica(handle) {
  const replica = { requests: [] };
  const server = createServer(async (request, response) => {
    const chunks = [];
    for await (const chunk of request) chunks.push(chunk);
    if (request.url === "/readyz") {
      response.end();
      return;
    }
    replica.requests.push(request);
    handle(request, Buffer.concat(chunks).toString(), response);
  });
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  replica.port = server.address().port;
  replica.close = () => {
    server.closeAllConnections();
    server.close();
  };
  return replica;
}

/** A balancer of three ports of replicas: {port, log, logged, stop}. */
export async function startBalancer(replicaPorts) {
  const folder = mkdtempSync(join(tmpdir(), "balancer-"));
  const [port, metricsPort] = await freePorts(2);
  const file = join(folder, "haproxy.cfg");
  writeFileSync(file, configuration(port, metricsPort, replicaPorts));
  const child = spawn("haproxy", ["-db", "-f", file], { env: ENV, stdio: ["ignore", "pipe", "pipe"] });
  const balancer = { port, log: "", ended: undefined };
  child.once("error", (error) => (balancer.ended = String(error)));
  child.once("exit", (code) => (balancer.ended = `exit code ${code}: ${balancer.log}`));
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => (balancer.log += data));
  balancer.logged = (text) => until(() => balancer.log.includes(text));
  balancer.stop = async () => {
    if (balancer.ended === undefined) {
      child.kill("SIGKILL");
      await once(child, "exit");
    }
    rmSync(folder, { recursive: true });
  };
  const usesAll = async () => {
    if (balancer.ended !== undefined) throw new Error(`haproxy ended: ${balancer.ended}`);
    return (await activeServers(metricsPort)) === replicaPorts.length;
  };
  try {
    await until(usesAll);
  } catch (error) {
    await balancer.stop();
    throw error;
  }
  return balancer;
}

/** Sends a request that closes its connection; returns all that is answered. */
export async function exchange(port, text) {
  const socket = createConnection(port, "127.0.0.1");
  socket.write(text);
  const chunks = [];
  for await (const chunk of socket) chunks.push(chunk);
  return Buffer.concat(chunks).toString();
}

function configuration(port, metricsPort, replicaPorts) {
  const text = textOf("deploy/haproxy/haproxy.cfg")
    .replace("bind :8000", `bind 127.0.0.1:${port}`)
    .replace("bind :8404", `bind 127.0.0.1:${metricsPort}`)
    .replace("check port 8081", "check");
  return replicaPorts.reduce(
    (result, replica, i) => result.replace(`fleetplan-${i + 1}:8080`, `127.0.0.1:${replica}`),
    text,
  );
}

async function activeServers(metricsPort) {
  try {
    const answer = await fetch(`http://127.0.0.1:${metricsPort}/metrics`);
    const text = await answer.text();
    return Number(/^haproxy_backend_active_servers\{proxy="replicas"\} (\d+)/m.exec(text)?.[1]);
  } catch {
    return 0; // it does not listen yet
  }
}

async function until(condition) {
  const end = Date.now() + START_MS;
  while (!(await condition())) {
    if (Date.now() > end) throw new Error(`not within ${START_MS} ms: ${condition}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
