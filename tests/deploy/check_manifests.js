// Reports the faults of the Kubernetes manifests on stdin, as `kubectl kustomize` prints them. Exit code 1 if there are
// any.

import { readFileSync } from "node:fs";

import { faultsOf, resourcesOf } from "./support/manifests.js";

const resources = resourcesOf(readFileSync(0, "utf8"));
const faults = resources.length > 0 ? faultsOf(resources) : ["there are no manifests"];
for (const fault of faults) console.error(fault);
process.exitCode = faults.length > 0 ? 1 : 0;
