// From files to what to open: {name, example: null, text, request, answer or null}; or {name, advance}, the text of a
// request of POST /v1/advance. Dialogs ask where there is a choice.

import { asRows } from "../model/drawn_map.js";
import { belongsTo, isOfAdvance, readDocument } from "../model/plan_file.js";
import { FileError } from "../model/problem.js";
import { megabytes } from "../ui/format.js";
import { HEAD_BYTES, imageNamed, sortFiles } from "./file_kinds.js";
import { checkMapOf, readMovingAiScenario } from "./movingai.js";
import { RosMapDialog } from "./ros_dialog.js";
import { readRosYaml } from "./ros_map.js";
import { ScenarioDialog } from "./scenario_dialog.js";

/** @import {Answer, Request} from "../model/types.js" */

const SPEEDS = { linear_speed: 1, angular_speed: 3.1416 }; // m/s, rad/s
const CELL_SHARE = 0.4; // default radius on MovingAI maps, of a cell's side
const DEEPEST = 100; // nesting of JSON, until the service's limit is known
const INDOOR_RADIUS = 0.2; // metres, default radius on ROS maps

export class Reader {
  #session;
  #work;
  #dialogs;
  #turn = 0; // counts dismissals, so that files that take long to read show no dialog after one

  /** `work`: see MAP_WORK. */
  constructor(session, work) {
    this.#session = session;
    this.#work = work;
    this.#dialogs = new ImportDialogs(session, work);
  }

  /** Closes the dialog that is open, if there is one, and the dialogs of files that are still being read. */
  dismiss() {
    this.#turn += 1;
    this.#dialogs.dismiss();
  }

  /** What files (File) contain together; null if their dialog is cancelled. Rejects with FileError. */
  async files(files) {
    const turn = this.#turn;
    const heads = await Promise.all(files.map(headOf));
    /** @type {any} */
    const sorted = sortFiles(files.map((file, at) => ({ name: file.name, head: heads[at], file })));
    switch (sorted.kind) {
      case "json":
        for (const { file } of sorted.files) this.#checkSize(file);
        return this.#documents(
          await Promise.all(sorted.files.map(async ({ name, file }) => ({ name, text: await textOf(file) }))),
        );
      case "map":
        return opened(sorted.map.name, withoutRobots(await this.#readMap(sorted.map.file), CELL_SHARE));
      case "scenario":
        return this.#scenario(sorted, turn);
      default:
        return this.#rosMap(sorted, turn);
    }
  }

  /** Throws FileError for a document that the service would refuse by its size, which takes long to read. */
  #checkSize({ name, size }) {
    const most = this.#session.limits.max_body ?? Infinity;
    if (size <= most) return;
    throw new FileError(
      `${name} has ${megabytes(size)}, and the service accepts at most ${megabytes(most)}.`,
    );
  }

  /** What a JSON text contains. Throws FileError. */
  text(name, text) {
    return this.#documents([{ name, text }]);
  }

  /** What the texts of a request and of its answer contain together. Throws FileError. */
  pair(name, request, answer) {
    return this.#documents([request, answer].map((text) => ({ name, text })));
  }

  /** One document, or two of which one is the request and the other its answer: [{name, text}]. */
  #documents(documents) {
    const { max_body = Infinity, max_depth = DEEPEST } = this.#session.limits;
    const read = documents.map(({ name, text }) => ({
      name,
      text,
      ...about({ name }, () => {
        checkExtent(text, max_body, max_depth);
        return readJson(text);
      }),
    }));
    const whole = read.find(({ request }) => request !== null);
    const alone = read.find(({ request }) => request === null);
    if (read.length === 1 && read[0].isOfAdvance) return { name: read[0].name, advance: read[0].text };
    if (read.length === 2 && (!whole || !alone || whole.answer !== null || alone.answer === null)) {
      throw new FileError(
        `${read[0].name} and ${read[1].name} are not a request and its answer: open one after the other.`,
      );
    }
    if (!alone) {
      const { name, text, request, answer } = whole;
      return answer === null ? opened(name, request, null, text) : opened(name, request, answer);
    }
    const { request } = whole ?? this.#session;
    if (!belongsTo(alone.answer, request)) {
      throw new FileError(
        whole
          ? `${alone.name} plans robots that ${whole.name} does not have: open it with its own request.`
          : `${alone.name} is an answer without its request, and of other robots than those shown: ` +
            "open it together with its request.",
      );
    }
    return opened(whole?.name ?? this.#session.name, request, alone.answer);
  }

  async #scenario({ scenario, map: drawn }, turn) {
    const text = await textOf(scenario.file);
    const entries = about(scenario, () => readMovingAiScenario(text));
    const map = drawn ? await this.#readMap(drawn.file) : this.#openMap(scenario.name, entries[0]);
    about(scenario, () => checkMapOf(entries, map));
    if (turn !== this.#turn) return null;
    const defaults = { radius: Number((CELL_SHARE * map.resolution).toPrecision(6)), ...SPEEDS };
    const request = await this.#dialogs.scenario(scenario.name, map, entries, defaults);
    return request && opened(scenario.name, request);
  }

  /** The open map, if the scenario can be for this map. */
  #openMap(name, { map: mapName, width, height }) {
    const { grid } = this.#session.scene;
    if (grid?.rows === height && grid.lines.every((line) => line.length === width))
      return { ...asRows(grid.map), resolution: grid.resolution, origin: grid.origin };
    throw new FileError(
      `${name} is for the map ${mapName} of ${width} x ${height} cells, not the one shown: open both together.`,
    );
  }

  async #rosMap({ yaml, images }, turn) {
    const text = await textOf(yaml.file);
    const described = about(yaml, () => readRosYaml(text));
    const image = imageNamed(described.image, images, yaml.name);
    const bytes = await bytesOf(image.file);
    const read = await about(image, () => this.#work.readRosImage(described, bytes));
    if (turn !== this.#turn) return null;
    const map = await this.#dialogs.rosMap(yaml.name, read, described.warnings);
    return map && opened(yaml.name, withoutRobots(map, INDOOR_RADIUS));
  }

  async #readMap(file) {
    const text = await textOf(file);
    return about(file, () => this.#work.readMovingAiMap(text));
  }
}

function opened(name, request, /** @type {Answer | null} */ answer = null, text = JSON.stringify(request)) {
  return { name, example: null, text, request, answer };
}

function withoutRobots(map, radius) {
  return { map, robot_defaults: { radius, ...SPEEDS }, robots: [] };
}

/** Throws FileError for a text that the service would refuse by its size or depth, before work is done for it. */
function checkExtent(text, most, deepest) {
  if (text.length > most)
    throw new FileError(
      `It has ${megabytes(text.length)}, and the service accepts at most ${megabytes(most)}.`,
    );
  const depth = depthOf(text, deepest);
  if (depth > deepest)
    throw new FileError(`Its lists and objects are nested more than ${deepest} deep, the service's limit.`);
}

/** How deep a JSON text is nested, or more than `most` once that is certain. */
function depthOf(text, most) {
  let [depth, deepest, isText] = [0, 0, false];
  for (let at = 0; at < text.length && deepest <= most; at += 1) {
    const letter = text[at];
    if (isText && letter === "\\") at += 1;
    else if (letter === '"') isText = !isText;
    else if (!isText && (letter === "[" || letter === "{")) deepest = Math.max(deepest, (depth += 1));
    else if (!isText && (letter === "]" || letter === "}")) depth -= 1;
  }
  return deepest;
}

function readJson(text) {
  let document;
  try {
    document = JSON.parse(text);
  } catch (error) {
    throw new FileError(`It is not JSON: ${/** @type {Error} */ (error).message}.`);
  }
  return isOfAdvance(document) ? { request: null, answer: null, isOfAdvance: true } : readDocument(document);
}

/** The first bytes of a file, enough to determine its kind. */
export const headOf = (file) =>
  reading(file, async () => bytesIn(await file.slice(0, HEAD_BYTES).arrayBuffer()));

export const textOf = (file) => reading(file, () => file.text());

export const bytesOf = (file) => reading(file, async () => bytesIn(await file.arrayBuffer()));

/** The result of `read`, or what it resolves to; adds the name of the file to a FileError. */
export function about({ name }, read) {
  const named = (error) => {
    throw error instanceof FileError ? new FileError(`${name}: ${error.message}`) : error;
  };
  try {
    const made = read();
    return made instanceof Promise ? made.catch(named) : made;
  } catch (error) {
    return named(error);
  }
}

function bytesIn(buffer) {
  return new Uint8Array(buffer);
}

async function reading({ name }, read) {
  try {
    return await read();
  } catch {
    throw new FileError(`${name} cannot be read. Is it a folder, or was it moved or changed meanwhile?`);
  }
}

/** The dialogs about files with a choice; one at a time. */
class ImportDialogs {
  #session;
  #work;
  /** @type {RosMapDialog | ScenarioDialog | null} */
  #shown = null;

  constructor(session, work) {
    this.#session = session;
    this.#work = work;
  }

  /** Resolves to a request with robots of a scenario, or to null if it is cancelled. */
  scenario(name, map, entries, defaults) {
    const most = this.#session.limits.max_robots ?? Infinity;
    return this.#ask(new ScenarioDialog(name, map, entries, defaults, most));
  }

  /** Resolves to the map of a request, or to null if it is cancelled. */
  rosMap(name, read, warnings) {
    const most = this.#session.limits.max_cells ?? Infinity;
    return this.#ask(new RosMapDialog(name, read, warnings, most, this.#work));
  }

  /** Cancels the current dialog. */
  dismiss() {
    this.#shown?.cancel();
  }

  async #ask(dialog) {
    this.#shown = dialog;
    try {
      return await dialog.ask();
    } finally {
      if (this.#shown === dialog) this.#shown = null;
    }
  }
}
