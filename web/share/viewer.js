// The script of a shared HTML file: shows the request and plan that it contains.

import { saveText } from "../files/downloads.js";
import { MAP_WORK } from "../files/map_work.js";
import { prepareRequest } from "../files/prepare.js";
import { readDocument } from "../model/plan_file.js";
import { Session } from "../model/session.js";
import { watchReadout, watchViewMenu } from "../panels/scene_bar.js";
import { TimeEntry } from "../panels/time_entry.js";
import { Transport } from "../panels/transport.js";
import { showLattice } from "../scene/lattice_overlay.js";
import { RobotColours } from "../scene/palette.js";
import { showScale } from "../scene/scale_bar.js";
import { Stage } from "../scene/stage.js";
import { byId, setText } from "../ui/dom.js";
import { count, seconds } from "../ui/format.js";
import { watchShortcuts } from "../ui/input.js";

const { name, document: shared } = JSON.parse(byId("shared").textContent);
const { request, answer } = /** @type {any} */ (readDocument(shared));
await prepareRequest(request, MAP_WORK, async () => {});

const session = new Session({}, requestAnimationFrame.bind(window));
const stage = new Stage(session, new RobotColours());
const transport = new Transport(session);
const timeEntry = new TimeEntry(session);
showScale(stage);
showLattice(session, stage);
watchReadout(session);
watchViewMenu(stage);
watchShortcuts({
  " ": () => session.togglePlaying(),
  r: () => transport.restart(),
  l: () => transport.toggleLoop(),
  j: () => timeEntry.begin(),
  ",": () => transport.step(-1),
  ".": () => transport.step(1),
  f: () => stage.fit(),
  "+": () => stage.zoomIn(),
  "-": () => stage.zoomOut(),
  Escape: () => session.select(null),
});
byId("save-plan").addEventListener("click", () => saveText(`${name}.plan.json`, JSON.stringify(shared)));

session.open({ name, example: null, text: "", request }, answer);
setText(byId("title"), name);
const robots = count(session.scene.robots.length, "robot");
setText(
  byId("facts"),
  `${robots}, flowtime ${seconds(answer.flowtime)}, makespan ${seconds(answer.makespan)}`,
);
