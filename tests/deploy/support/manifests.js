// Checks Kubernetes manifests against the schemas of Kubernetes, in two steps. First, the validation of the schemas,
// which accepts unknown members. Then, their TypeScript types, which do not.

import { createRequire } from "node:module";

import { loadAll } from "js-yaml";
import ts from "typescript";

const require = createRequire(import.meta.url);

/** The resources in a text of YAML documents. */
export function resourcesOf(text) {
  return loadAll(text).filter((resource) => resource !== null && resource !== undefined);
}

/** The faults of resources, as sentences that begin with their kind and name. */
export function faultsOf(resources) {
  const faults = [];
  const sources = new Map();
  for (const [index, resource] of resources.entries()) {
    const { apiVersion, kind, metadata } = resource;
    const name = `${kind} ${metadata?.name}`;
    const Model = modelOf(apiVersion, kind);
    if (!Model) {
      faults.push(`${name}: there is no ${kind} in ${apiVersion}`);
      continue;
    }
    const fault = schemaFault(Model, resource);
    if (fault) faults.push(`${name}: ${fault}`);
    sources.set(new URL(`resource-${index}.ts`, import.meta.url).pathname, { name, text: typed(resource) });
  }
  return [...faults, ...typeFaults(sources)];
}

function modelOf(apiVersion, kind) {
  try {
    return require(`kubernetes-models/${apiVersion}`)[kind];
  } catch {
    return undefined;
  }
}

function schemaFault(Model, resource) {
  try {
    new Model(resource).validate();
    return undefined;
  } catch (error) {
    return error.message;
  }
}

/** An object literal of a declared type must not have members that the type does not have. */
function typed(resource) {
  const { apiVersion, kind } = resource;
  return `import type { I${kind} } from "kubernetes-models/${apiVersion}";
export const it: I${kind} = ${JSON.stringify(resource)};
`;
}

/** What TypeScript has read of the types, by path: reading takes most of the time of a check. */
const declarations = new Map();

/** The errors that TypeScript reports for sources in memory: a Map of {name, text} by path. */
function typeFaults(sources) {
  const options = { strict: true, noEmit: true, skipLibCheck: true, types: [] };
  options.moduleResolution = ts.ModuleResolutionKind.Node10;
  const host = ts.createCompilerHost(options);
  const { getSourceFile, fileExists } = host;
  host.fileExists = (path) => sources.has(path) || fileExists.call(host, path);
  host.getSourceFile = (path, version) => {
    if (sources.has(path)) return ts.createSourceFile(path, sources.get(path).text, version);
    if (!declarations.has(path)) declarations.set(path, getSourceFile.call(host, path, version));
    return declarations.get(path);
  };
  const program = ts.createProgram([...sources.keys()], options, host);
  return ts.getPreEmitDiagnostics(program).map((diagnostic) => {
    const { name } = sources.get(diagnostic.file?.fileName) ?? { name: "all" };
    return `${name}: ${ts.flattenDiagnosticMessageText(diagnostic.messageText, " ")}`;
  });
}
