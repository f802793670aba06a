// Puts the page together. Each feature attaches to the session and is independent of the others.

import { EditPanel } from "./edit/edit_panel.js";
import { Address } from "./files/address.js";
import { ExampleChoice } from "./files/example_choice.js";
import { keptPlans, keptRequests } from "./files/kept.js";
import { mapTasks } from "./files/map_tasks.js";
import { Opening } from "./files/opening.js";
import { PlanKeeper } from "./files/plan_keeper.js";
import { fileStem, watchSaving } from "./files/save.js";
import { watchSharing } from "./files/sharing.js";
import { Setup } from "./files/setup.js";
import { Visits } from "./files/visits.js";
import { offerHook } from "./hook.js";
import { watchRequest } from "./model/checks.js";
import { EarlierPlans } from "./model/earlier_plans.js";
import { clearanceJob, FleetMotion } from "./model/fleet_motion.js";
import { RobotFilter } from "./model/robot_filter.js";
import { watchKeptPlan } from "./model/kept_plan.js";
import { Session } from "./model/session.js";
import { TravelTimes } from "./model/travel_times.js";
import { watchCheck } from "./panels/check_card.js";
import { watchChosen } from "./panels/comparison_card.js";
import { embed, showMomentOfPlan } from "./panels/embedded.js";
import { Inspector } from "./panels/inspector.js";
import { watchLazyTab } from "./panels/lazy_tab.js";
import { OptionsPanel } from "./panels/options_panel.js";
import { budgetOf, PlanButton, PlanningStatus } from "./panels/planning_panel.js";
import { revealProblem, watchProblem } from "./panels/problem_card.js";
import { RobotFinder } from "./panels/robot_finder.js";
import { RobotList } from "./panels/robot_list.js";
import { watchReadout, watchViewMenu } from "./panels/scene_bar.js";
import { inShort, watchSummary } from "./panels/summary.js";
import { TimelineDock } from "./panels/timeline_dock.js";
import { TimeEntry } from "./panels/time_entry.js";
import { Transport } from "./panels/transport.js";
import { watchTravelTimes } from "./panels/travel_card.js";
import { watchUnplanned } from "./panels/unplanned_card.js";
import { FIRST_EXAMPLE, welcome } from "./panels/welcome.js";
import { BoxSelection } from "./scene/box_selection.js";
import { Follow } from "./scene/follow.js";
import { ClosestOverlay, showBlockers, showViolations } from "./scene/overlays.js";
import { showMoment } from "./scene/pair_view.js";
import { RobotColours } from "./scene/palette.js";
import { showLattice } from "./scene/lattice_overlay.js";
import { Minimap } from "./scene/minimap.js";
import { Ruler } from "./scene/ruler.js";
import { showScale } from "./scene/scale_bar.js";
import { Stage } from "./scene/stage.js";
import * as service from "./service/client.js";
import { byId, setText } from "./ui/dom.js";
import { watchShortcuts } from "./ui/input.js";
import { Preferences } from "./ui/preferences.js";
import { Tabs } from "./ui/tabs.js";

const isEmbedded = new URLSearchParams(location.search).has("embed");
const visits = new Visits(isEmbedded);
const preferences = new Preferences();
const session = new Session(service, requestAnimationFrame.bind(window));
const colours = new RobotColours();
const earlier = new EarlierPlans(session);
const stage = new Stage(session, colours);
const fleet = new FleetMotion(session, clearanceJob());
const closest = new ClosestOverlay(session, stage, fleet);
const tabs = new Tabs(byId("tabs"));
const transport = new Transport(session, preferences);
const show = (part) => {
  if (part === "problem") revealProblem();
  else if (part === "robots") edit.pick("robot");
  else tabs.choose(part === "comparison" ? "tab-analyse" : `tab-${part}`);
  if (part === "comparison") earlier.compare();
};
const work = mapTasks();
const opening = new Opening(session, service, show, work);
const address = new Address(session, opening, keptRequests());
const keeper = new PlanKeeper(session, opening, keptPlans());
const setup = new Setup(session, opening, new ExampleChoice(colours, service.fetchExample, work));
const planButton = new PlanButton(session, transport);
const edit = new EditPanel(session, stage, tabs, opening, inShort);
watchRequest(session, service.validate);
watchKeptPlan(session, service.validate);
new PlanningStatus(session);
const options = new OptionsPanel(session, tabs, service.fetchOpenApi);
const filter = new RobotFilter(session);
new RobotList(session, colours, filter);
const finder = new RobotFinder(session, stage, tabs, filter);
watchChosen(session, stage, fleet);
stage.setBaseTool(new BoxSelection(session, stage));
showScale(stage);
showLattice(session, stage);
new Minimap(session, stage);
const ruler = new Ruler(session, stage);
const timeEntry = new TimeEntry(session);
const follow = new Follow(session, stage);
const timeline = new TimelineDock(
  session,
  colours,
  fleet,
  transport,
  (over) => closest.peek(over),
  (ids, t) => showMoment(session, stage, ids, t),
  preferences,
);
new Inspector(session, stage, colours, fleet, tabs);
watchSummary(session, fleet, (ids, t) => showMoment(session, stage, ids, t));
watchCheck(session, stage);
showBlockers(session, stage);
showViolations(session, stage, fleet);
watchUnplanned(session, budgetOf, () => planButton.press());
watchReadout(session);
watchSaving(session, address, service.needsToken);
watchSharing(
  session,
  stage,
  { animation: () => import("./share/animation.js"), page: () => import("./share/html_page.js") },
  () => fileStem(session.name),
);
watchViewMenu(stage, preferences);
watchTravelTimes(session, stage, new TravelTimes(session, service, () => performance.now()));
watchProblem(session, stage, tabs, edit.choice, () => options.load());
watchLazyTab(tabs, "analyse", async () => {
  const { fillAnalysis } = await import("./analysis/analysis_panel.js");
  return (panel) => fillAnalysis(panel, { session, stage, timeline, fleet, service, earlier });
});
service.watchLate((isLate) => {
  setText(byId("late"), isLate ? "The service has not answered for 10 s. The page still waits for it." : "");
});
session.on("announcement", (text) => setText(byId("announcer"), text));

watchShortcuts({
  " ": () => session.togglePlaying(),
  r: () => transport.restart(),
  l: () => transport.toggleLoop(),
  p: () => planButton.press(),
  ",": () => transport.step(-1),
  ".": () => transport.step(1),
  "[": () => transport.changeSpeed(-1),
  "]": () => transport.changeSpeed(1),
  c: () => closest.toggle(),
  f: () => stage.fit(),
  m: () => ruler.toggle(),
  j: () => timeEntry.begin(),
  F: () => follow.toggle(),
  "/": () => finder.focus(),
  "+": () => stage.zoomIn(),
  "=": () => stage.zoomIn(),
  "-": () => stage.zoomOut(),
  v: () => edit.pick("select"),
  w: () => edit.pick("wall"),
  e: () => edit.pick("erase"),
  b: () => edit.pick("box"),
  a: () => edit.pick("robot"),
  z: () => edit.pick("zone"),
  "Control+z": () => session.undo(),
  "Control+Shift+z": () => session.redo(),
  "Control+y": () => session.redo(),
  Escape: () => (session.planning ? session.cancel() : session.select(null)),
});

document.addEventListener("visibilitychange", () => session.player.skip());

offerHook(session, stage, fleet);
visits.readUnkept = () => ({ request: address.unkept, plan: keeper.unkept });
if (isEmbedded) embed(session);
setup.begin(service, address, keeper, visits.unkept, visits.isFirst ? FIRST_EXAMPLE : null).then(async () => {
  if (isEmbedded || address.moment !== null) await showMomentOfPlan(session, address.moment ?? 0);
  else if (visits.isFirst) welcome(session, () => planButton.press());
});
service.fetchVersion().then(
  (version) => setText(byId("version"), `Fleetplan ${version}`),
  () => {}, // what else is asked tells it
);
