// The Analyse tab: what can be learnt about a plan beyond its figures. Loaded when it is first opened.

import { Ghosts } from "../scene/ghosts.js";
import { OtherScene } from "../scene/other_scene.js";
import { element } from "../ui/dom.js";
import { CompareSection } from "./compare_section.js";
import { DependenciesSection } from "./dependencies_section.js";
import { FleetSection } from "./fleet_section.js";
import { SimulationSection } from "./simulation_section.js";

/** `page` has session, stage, timeline, fleet, service and earlier. */
export function fillAnalysis(panel, page) {
  const ghosts = new Ghosts(page.session, page.stage);
  const compare = new CompareSection({ ...page, ghosts, other: new OtherScene(page.session, page.stage) });
  const comparing = section("Compare plans", compare.element);
  panel.append(
    section("Simulate delays", new SimulationSection({ ...page, ghosts }).element, true),
    comparing,
    section("Continuous operation", new FleetSection(page).element),
    section("Dependencies", new DependenciesSection(page).element),
  );
  page.earlier.onAsked(() => {
    comparing.open = true;
    comparing.scrollIntoView({ block: "nearest" });
    compare.withPlanBefore();
  });
}

function section(title, content, open = false) {
  return element("details", { class: "section", open }, element("summary", { textContent: title }), content);
}
