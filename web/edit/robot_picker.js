// The list from which every robot of the request can be chosen, also one too faulty to be seen in the scene. Those that
// the service finds faults with are marked.

import { nameOf, robotsOf } from "../model/edit_robots.js";
import { robotIndexOf } from "../model/pointer.js";
import { byId, element, setText } from "../ui/dom.js";

export function watchRobotPicker(session, choice) {
  const list = byId("edited-robot");
  list.addEventListener("change", () => choice.choose(list.value === "" ? null : Number(list.value)));
  session.on("request problem", () => {
    list.replaceChildren(...optionsFor(session));
    list.value = choice.index ?? "";
    const many = robotsOf(session.request).length > 0;
    list.disabled = !many;
    setText(
      byId("no-robot"),
      many
        ? "Choose a robot here, or press one in the scene."
        : "A request needs at least one robot: take the robot tool and press in the scene.",
    );
  });
  session.on("marks", () => (list.value = choice.index ?? ""));
}

function optionsFor({ request, problem }) {
  const faulty = new Set((problem?.errors ?? []).map(({ pointer = "" }) => robotIndexOf(pointer)));
  const robots = robotsOf(request);
  const none = robots.length > 0 ? "None chosen" : "No robots yet";
  return [
    element("option", { value: "", textContent: none }),
    ...robots.map((_, index) => {
      const textContent = `${faulty.has(index) ? "⚠ " : ""}${nameOf(request, index)}`;
      return element("option", { value: String(index), textContent });
    }),
  ];
}
