// The kinds of files opened or dropped together, by their names and first bytes.

import { FileError } from "../model/problem.js";
import { isPng } from "./png.js";

const BY_ENDING = {
  json: "json",
  map: "map",
  scen: "scenario",
  yaml: "yaml",
  yml: "yaml",
  pgm: "image",
  png: "image",
};
const KINDS = {
  json: "a request or a plan",
  map: "a MovingAI map",
  scenario: "a MovingAI scenario",
  yaml: "a description of a ROS map",
  image: "an image of a ROS map",
};
const OPENED =
  "requests and plans (.json), MovingAI maps and scenarios (.map, .scen), " +
  "ROS maps (.yaml with .pgm or .png)";

/** The extensions of files that can be opened, for an <input>'s `accept`. */
export const ACCEPT = [...Object.keys(BY_ENDING).map((ending) => `.${ending}`), "application/json"].join(",");

/** The number of first bytes, `head`, that determine the kind of a file. */
export const HEAD_BYTES = 512;

/** The kind of a file {name, head}: "json", "map", "scenario", "yaml" or "image"; or null. */
export function kindOf({ name, head }) {
  const ending = /\.([^.]+)$/.exec(name)?.[1].toLowerCase();
  return BY_ENDING[ending] ?? kindOfContent(head);
}

function kindOfContent(head) {
  const text = new TextDecoder().decode(head); // which drops a byte order mark
  if (/^P[25]\s/.test(text) || isPng(head)) return "image";
  if (text.includes("\0")) return null;
  if (/^\s*\{/.test(text)) return "json";
  if (/^type\s+\S+\s+(height|width|map)\b/.test(text)) return "map";
  if (/^version\s+[\d.]+\s+\d+\s+\S+\s+\d+\s+\d+\s/.test(text)) return "scenario";
  return /^image\s*:/m.test(text) ? "yaml" : null;
}

/**
 * What files [{name, head: Uint8Array}] opened together are. Throws FileError, with the files' names in it, for other
 * combinations than these:
 *
 * - {kind: "json", files: one or two}
 * - {kind: "map", map}
 * - {kind: "scenario", scenario, map: or null}
 * - {kind: "ros", yaml, images}
 */
export function sortFiles(files) {
  /** @type {Record<string, any[]>} */
  const sorted = { json: [], map: [], scenario: [], yaml: [], image: [] };
  for (const file of files) {
    const kind = kindOf(file);
    if (kind === null) throw new FileError(`${file.name} is not a supported file: ${OPENED}.`);
    sorted[kind].push(file);
  }
  const kinds = Object.keys(sorted).filter((kind) => sorted[kind].length > 0);
  const counts = kinds.map((kind) => sorted[kind].length);
  const { json, map, scenario, yaml, image } = sorted;
  switch (kinds.join(" ")) {
    case "json":
      if (json.length <= 2) return { kind: "json", files: json };
      break;
    case "map":
      if (map.length === 1) return { kind: "map", map: map[0] };
      break;
    case "scenario":
    case "map scenario":
      if (counts.every((count) => count === 1))
        return { kind: "scenario", scenario: scenario[0], map: map[0] ?? null };
      break;
    case "yaml":
    case "yaml image":
      if (yaml.length === 1) return { kind: "ros", yaml: yaml[0], images: image };
      break;
    case "image":
      throw new FileError(
        `${image[0].name} is only the image of a map: open it together with its map.yaml, which has ` +
          "the size of a pixel.",
      );
  }
  const listed = files.map((file) => `${file.name} is ${KINDS[kindOf(file)]}`).join(", ");
  throw new FileError(
    `These files cannot be opened together: ${listed}. Open a request, a plan, a map, a map with its scenario, or a ` +
      "map.yaml with its image.",
  );
}

/** The file that a map.yaml names as its `image`, in any folder. Throws FileError if it is not there. */
export function imageNamed(path, images, yamlName) {
  const name = path.split(/[\\/]/).pop();
  const found = images.find((image) => image.name === name);
  if (found) return found;
  const instead = images.length > 0 ? `, not ${images.map((image) => image.name).join(" or ")}` : "";
  throw new FileError(`${yamlName} names the image ${name}${instead}: open both together.`);
}
