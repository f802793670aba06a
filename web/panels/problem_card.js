// What went wrong, with each error's place: pressing an error leads there.

import { nameOf } from "../model/edit_robots.js";
import { mapRowOf, robotIndexOf } from "../model/pointer.js";
import { byId, element } from "../ui/dom.js";
import { count } from "../ui/format.js";

const MOST_ERRORS = 100; // to list; nobody reads more

/** Shows the session's problem. `show(pointer)` leads to the place of an error. */
export function watchProblem(session, show) {
  session.on("problem", () => showProblem(session.problem, session.request, show));
}

/** Brings the problem into sight where the page is longer than the window, as on a phone. */
export function revealProblem() {
  byId("problem").scrollIntoView({ block: "center" });
}

function showProblem(problem, request, show) {
  const box = byId("problem");
  box.hidden = problem === null;
  box.replaceChildren();
  if (problem === null) return;
  box.append(element("h2", { textContent: problem.title }));
  if (problem.detail) box.append(element("p", { textContent: problem.detail }));
  if (problem.retry_after) {
    box.append(element("p", { textContent: `Try again in ${count(problem.retry_after, "second")}.` }));
  }
  if (problem.errors?.length > 0) box.append(errorList(problem.errors, request, show));
  if (problem.request_id) {
    box.append(element("p", { class: "request-id", textContent: `Request ${problem.request_id}` }));
  }
}

function errorList(errors, request, show) {
  const list = element("ul", { class: "errors" });
  for (const { pointer = "", detail } of errors.slice(0, MOST_ERRORS)) {
    const place = element("button", { type: "button", class: "error", "data-error": pointer });
    place.append(
      element("span", { class: "error-place" }, placeInWords(pointer, request)),
      element("code", { textContent: pointer || "(whole request)" }),
      element("span", { textContent: detail }),
    );
    place.addEventListener("click", () => show(pointer));
    list.append(element("li", {}, place));
  }
  const more = errors.length - MOST_ERRORS;
  if (more > 0) list.append(element("li", { textContent: `and ${count(more, "more", "more")}` }));
  return list;
}

/** What a pointer leads to, as a person would say. */
function placeInWords(pointer, request) {
  const index = robotIndexOf(pointer);
  if (index !== null) return nameOf(request, index);
  const row = mapRowOf(pointer);
  if (row !== null) return `Row ${row + 1} of the map`;
  if (pointer.startsWith("/map")) return "Map";
  if (pointer.startsWith("/options")) return "Option";
  return "Request";
}
