// The list from which every robot of the request can be chosen, also one too faulty to be seen in the scene.
// Those that the service finds faults with are marked.

import { nameOf, robotsOf } from "../model/edit_robots.js";
import { robotIndexOf } from "../model/pointer.js";
import { byId, element, setText } from "../ui/dom.js";

const HOW_TO_CHOOSE = "Choose a robot here, or press one in the scene.";
const HOW_TO_ADD = "A request needs at least one robot: take the robot tool and press in the scene.";

export function watchRobotPicker(session, choice) {
  const list = byId("edited-robot");
  list.addEventListener("change", () => choice.choose(list.value === "" ? null : Number(list.value)));
  let listed = [];
  session.on("request problem", () => {
    const names = namesOf(session);
    if (names.join("\n") !== listed.join("\n")) {
      listed = names;
      list.replaceChildren(
        ...names.map((name, at) => element("option", { value: at - 1, textContent: name })),
      );
      list.options[0].value = "";
    }
    list.value = choice.index ?? "";
    list.disabled = names.length === 1;
    setText(byId("no-robot"), list.disabled ? HOW_TO_ADD : HOW_TO_CHOOSE);
  });
  session.on("marks", () => (list.value = choice.index ?? ""));
}

/** What to call no robot and each robot in turn. */
function namesOf({ request, problem }) {
  const faulty = new Set((problem?.errors ?? []).map(({ pointer = "" }) => robotIndexOf(pointer)));
  const sign = (index) => (faulty.has(index) ? "⚠ " : "");
  const names = robotsOf(request).map((_, index) => sign(index) + nameOf(request, index));
  return [names.length > 0 ? "None chosen" : "No robots yet", ...names];
}
