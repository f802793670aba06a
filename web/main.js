// Puts the page together: what is chosen, its answer, and who has to hear of a change.
//
// Scripting surface, read-only, for tests and the curious: `window.fleetplan` has `time`, `duration` (seconds),
// `playing`, `request` and `answer` (parsed JSON or null), `poseOf(id)` (the pose drawn now, metres and
// radians), `stateOf(id)` and `screenOf(id)` ({x, y, radius} of its disk on the canvas, CSS pixels).

import { fetchExample, fetchLimits, listExamples, plan, ProblemError } from "./client.js";
import { byId, setText } from "./dom.js";
import { copyText, curlCommand, fileStem, saveText } from "./exports.js";
import { count, degrees } from "./format.js";
import { robotColour, readTheme } from "./palette.js";
import { RobotList, showProblem, showSummary, showUnplanned, summarize } from "./panel.js";
import { Player } from "./player.js";
import { budgetOf, PlanningStatus } from "./planning_status.js";
import { readScene, readTracks, robotPoseAt, robotStateAt } from "./scene.js";
import { Setup } from "./setup.js";
import { watchShortcuts } from "./shortcuts.js";
import { Stage } from "./stage.js";
import { Transport } from "./transport.js";

const LIST_EVERY = 0.15; // seconds between updates of the robots' states while playing

const EMPTY = { name: "", example: null, text: "", parsed: null };
let chosen = EMPTY; // {name, example: name or null, text, parsed}
let scene = readScene(null);
let tracks = new Map();
let answered = null; // {answer, text} or null
let planning = null; // {control, incumbent}: an AbortController, and the text of the best answer so far or null
let limits = {}; // of the service
let loading = 0; // counts choices, so that a late example does not replace a newer choice
let examples = [];
let hovered = null;
let selected = null;
let listedAt = -Infinity;
let ticking = false; // a frame is on its way

const player = new Player();
const transport = new Transport(player, refresh);
const stage = new Stage({ hover, select });
const status = new PlanningStatus();
const list = new RobotList({ hover, select });
const setup = new Setup({
  example: chooseExample,
  file: chooseFile,
  text: chooseText,
  plan: startPlanning,
  cancel: cancelPlanning,
});

// Choosing a request

async function chooseExample(name) {
  const turn = (loading += 1);
  try {
    const text = await fetchExample(name);
    if (turn !== loading) return;
    adopt({ name, example: name, text, parsed: JSON.parse(text) });
  } catch (error) {
    if (turn !== loading) return;
    setup.setChosen(chosen.name, chosen.example === null);
    fail(error);
  }
}

async function chooseFile(file) {
  let text;
  try {
    text = await file.text();
  } catch (error) {
    fail(new ProblemError({ title: "The file cannot be read", detail: `${file.name}: ${error.message}` }));
    return;
  }
  chooseText(file.name, text);
}

/** Whether the text is JSON and now chosen. */
function chooseText(name, text) {
  let parsed;
  try {
    parsed = JSON.parse(text);
  } catch (error) {
    fail(new ProblemError({ title: "That is not JSON", detail: `${name}: ${error.message}` }));
    return false;
  }
  loading += 1;
  adopt({ name, example: null, text, parsed });
  return true;
}

function adopt(choice) {
  stopPlanning();
  chosen = choice;
  scene = readScene(choice.parsed);
  selected = hovered = null;
  setup.setChosen(choice.name, choice.example === null);
  history.replaceState(null, "", choice.example === null ? location.pathname : `#${choice.example}`);
  const listed = examples.find(({ name }) => name === choice.example);
  const { grid, robots } = scene;
  const size = grid ? `${grid.columns} × ${grid.rows} cells` : "no map";
  setup.describe(listed?.description ?? "", `${count(robots.length, "robot")}, ${size}`);
  setup.setReady(true);
  stage.describe(`Map of ${size} with ${count(robots.length, "robot")}`);
  showProblem(null);
  adoptAnswer(null);
  stage.fit();
}

function adoptAnswer(result) {
  answered = result;
  tracks = readTracks(scene, result?.answer ?? null);
  player.reset(Math.max(0, ...(result?.answer.plans ?? []).map(({ cost }) => cost)));
  stage.show(scene, tracks);
  showList();
  showSummary(result?.answer ?? null);
  showUnplanned(result?.answer.unplanned ?? [], select);
  byId("save-request").disabled = byId("copy-curl").disabled = chosen.text === "";
  byId("save-answer").disabled = result === null;
  refresh();
}

// Planning

async function startPlanning() {
  if (planning) return;
  const turn = (planning = { control: new AbortController(), incumbent: null });
  showProblem(null);
  adoptAnswer(null);
  setup.setPlanning(true);
  status.begin(budgetOf(chosen.parsed, limits));
  try {
    const result = await plan(chosen.text, turn.control.signal, {
      progress: (progress) => planning === turn && status.show(progress),
      incumbent: (text) => (turn.incumbent = text),
    });
    if (planning !== turn) return;
    const watching = document.activeElement === byId("cancel"); // which had the focus from Plan
    endPlanning();
    adoptAnswer(result);
    announce(summarize(result.answer));
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) player.play();
    refresh();
    if (watching) transport.focusPlay();
  } catch (error) {
    if (planning !== turn) return;
    endPlanning();
    fail(error);
  }
}

function endPlanning() {
  planning = null;
  status.end();
  setup.setPlanning(false);
}

/** The text of the best answer so far, or null. */
function stopPlanning() {
  const incumbent = planning?.incumbent ?? null;
  planning?.control.abort();
  if (planning) endPlanning();
  return incumbent;
}

function cancelPlanning() {
  if (!planning) return;
  const text = stopPlanning();
  if (text !== null) adoptAnswer({ answer: JSON.parse(text), text });
  announce(`Planning cancelled${text === null ? "" : ": this is the best plan so far"}.`);
}

function fail(error) {
  if (!(error instanceof ProblemError)) throw error;
  const idAt = (index) => scene.robots.find((robot) => robot.index === index)?.id ?? null;
  showProblem(error.problem, idAt, select);
}

function announce(text) {
  setText(byId("announcer"), text);
}

// What is pointed at and what is shown

function hover(id) {
  if (hovered === id) return;
  hovered = id;
  refresh();
}

function select(id) {
  selected = id === selected ? null : id;
  if (selected !== null) list.reveal(selected);
  refresh();
}

const robotOf = (id) => scene.robots.find((robot) => robot.id === id) ?? null;
const stateOf = (id) => (tracks.has(id) ? robotStateAt(tracks.get(id), player.time) : null);

function poseOf(id) {
  const robot = robotOf(id);
  return robot && robotPoseAt(robot, tracks.get(id), player.time);
}

const markedIds = () => new Set([hovered, selected].filter((id) => id !== null));

function refresh() {
  stage.update(player.time, markedIds());
  transport.refresh();
  refreshList();
  refreshReadout();
  if (player.playing && !ticking) {
    ticking = true;
    requestAnimationFrame(onFrame);
  }
}

function onFrame(milliseconds) {
  ticking = false;
  player.tick(milliseconds / 1000);
  if (!player.playing) {
    refresh();
    return;
  }
  stage.update(player.time, markedIds());
  transport.refresh();
  refreshReadout();
  if (milliseconds / 1000 - listedAt >= LIST_EVERY) refreshList();
  ticking = true;
  requestAnimationFrame(onFrame);
}

function showList() {
  const { robotLightness } = readTheme();
  list.show(scene, tracks, (index) => robotColour(index, robotLightness));
}

function refreshList() {
  list.update(stateOf, hovered, selected);
  listedAt = performance.now() / 1000;
}

function refreshReadout() {
  const id = hovered ?? selected;
  const pose = id === null ? null : poseOf(id);
  const readout = byId("readout");
  readout.hidden = pose === null;
  if (pose === null) return;
  setText(
    readout,
    `${id}: ${stateOf(id)} at (${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}) m, ${degrees(pose.theta)}`,
  );
}

// Controls that belong to the page as a whole

byId("save-request").addEventListener("click", () => saveText(`${fileStem(chosen.name)}.json`, chosen.text));
byId("save-answer").addEventListener("click", () =>
  saveText(`${fileStem(chosen.name)}.plan.json`, answered.text),
);
byId("copy-curl").addEventListener("click", async () => {
  const copied = await copyText(curlCommand(chosen, document.baseURI));
  const button = byId("copy-curl");
  setText(button, copied ? "Copied" : "Could not copy");
  announce(button.textContent);
  setTimeout(() => setText(button, "Copy as curl"), 1500);
});

watchShortcuts({
  " ": () => transport.toggle(),
  r: () => transport.restart(),
  l: () => transport.toggleLoop(),
  "[": () => transport.changeSpeed(-1),
  "]": () => transport.changeSpeed(1),
  f: () => stage.fit(),
  "+": () => stage.zoomIn(),
  "=": () => stage.zoomIn(),
  "-": () => stage.zoomOut(),
  Escape: () => (planning ? cancelPlanning() : select(null)),
});

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  showList();
  refresh();
});

document.addEventListener("visibilitychange", () => player.skip());

addEventListener("hashchange", () => {
  const named = namedExample();
  if (named && named.name !== chosen.example) chooseExample(named.name);
});

window.fleetplan = Object.freeze({
  get time() {
    return player.time;
  },
  get duration() {
    return player.duration;
  },
  get playing() {
    return player.playing;
  },
  get request() {
    return chosen.parsed;
  },
  get answer() {
    return answered?.answer ?? null;
  },
  poseOf,
  stateOf,
  screenOf(id) {
    const robot = robotOf(id);
    return robot && stage.screenOf(poseOf(id), robot.radius);
  },
});

// The first example stands ready when the page has loaded, or the one that the address names (#name)

function namedExample() {
  return examples.find(({ name }) => `#${name}` === location.hash);
}

async function begin() {
  fetchLimits().then(
    (fetched) => (limits = fetched),
    () => {}, // only the budget is not told then
  );
  try {
    examples = await listExamples();
  } catch (error) {
    setup.setExamples([]);
    fail(error);
    return;
  }
  setup.setExamples(examples);
  const first = namedExample() ?? examples[0];
  if (first && loading === 0) await chooseExample(first.name);
}

begin();
