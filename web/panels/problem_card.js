// The problem card, and its errors at their places: robots and rows in the scene, fields in the panels.
// Pressing a listed error leads to its place.

import { nameOf } from "../model/edit_request.js";
import { diskOf, groupFaults, placeOfFault } from "../model/faults.js";
import { mapRowOf, robotIndexOf } from "../model/problem.js";
import { markRow, markWrong } from "../scene/marks.js";
import { byId, element, keepInPlace } from "../ui/dom.js";
import { fieldOf, showFieldErrors, shownIn } from "../ui/field_errors.js";
import { count } from "../ui/format.js";

const FORMS = ["panel-edit", "panel-options"];
const LEADING = /^\/(robots\/\d|robot_defaults|map|options)/; // what has fields in the forms
const MAX_ERRORS = 100; // to list

/**
 * Shows the session's problem and marks its errors at their places. `choice`: see RobotChoice.
 * `loadOptions()` resolves when the form of the options is there.
 */
export function watchProblem(session, stage, tabs, choice, loadOptions) {
  const errors = () => session.problem?.errors ?? [];
  const forms = FORMS.map((id) => document.getElementById(id));

  const markErrors = (context, view) => {
    for (const { pointer = "" } of errors()) {
      const disk = diskOf(session.request, session.scene, pointer);
      const row = mapRowOf(pointer);
      if (row !== null && session.scene.grid) markRow(context, view, session.scene.grid, row);
      if (disk) markWrong(context, view, disk, disk.radius);
    }
  };
  stage.addOverlay(markErrors, { shared: true });

  const lead = async (pointer) => {
    if (isAboutOptions({ pointer })) await loadOptions();
    const index = robotIndexOf(pointer);
    const place = placeOfFault(session.request, session.scene, pointer);
    if (index !== null) choice.choose(index);
    if (place) stage.reveal(place);
    refresh();
    const form = forms.find((each) => fieldOf(each, pointer) !== null);
    if (form) focusOn(fieldOf(form, pointer), tabs);
  };
  const leads = (pointer) =>
    LEADING.test(pointer) || placeOfFault(session.request, session.scene, pointer) !== null;
  const listed = (problem) => errorList(problem, session.request, { lead, leads });

  // What is shown at its field is not shown once more in the card.
  const refresh = () =>
    keepInPlace(document.activeElement, () => {
      for (const form of forms) showFieldErrors(form, errors());
      showProblem(session.problem, (error) => !forms.some((form) => shownIn(form, error)), listed);
    });
  session.on("problem marks", refresh); // marks: the form may show another robot now
  tabs.onChange(refresh);
  session.on("problem", () => {
    stage.redraw();
    if (errors().some(isAboutOptions)) loadOptions().then(refresh);
  });
}

const isAboutOptions = ({ pointer = "" }) => pointer.startsWith("/options");

/** Focuses a field, or the first of a group of fields, and unfolds what hides it. */
function focusOn(field, tabs) {
  tabs.reveal(field);
  const details = field.closest("details");
  if (details) details.open = true;
  const control = field.matches("input, select") ? field : field.querySelector("input, select");
  control.focus();
}

/** Scrolls the problem, or the field that has it, into view on pages longer than the window, as on a phone. */
export function revealProblem() {
  const box = byId("problem");
  const place = box.hidden ? document.querySelector(".field-error") : box;
  place?.scrollIntoView({ block: "center" });
}

/** Shows a problem, with those of its errors that are `open`: not shown elsewhere. */
function showProblem(whole, open, listed) {
  const box = byId("problem");
  const errors = whole?.errors ?? [];
  const problem = whole && { ...whole, errors: errors.filter(open) };
  const isElsewhere = errors.length > 0 && problem.errors.length === 0;
  const unfolded = box.querySelector("details")?.open ?? false;
  box.hidden = problem === null || isElsewhere;
  box.replaceChildren();
  if (box.hidden) return;
  box.append(element("h2", { textContent: problem.title }));
  if (problem.detail) box.append(element("p", { textContent: problem.detail }));
  if (problem.retry_after) {
    box.append(element("p", { textContent: `Try again in ${count(problem.retry_after, "second")}.` }));
  }
  if (problem.errors.length > 0) box.append(listed(problem), pointersOf(problem.errors, unfolded));
  if (problem.again) box.append(againButton(problem.again));
  if (problem.request_id) {
    box.append(element("p", { class: "request-id", textContent: `Request ${problem.request_id}` }));
  }
}

function againButton(again) {
  const button = element("button", { type: "button", class: "again", textContent: "Try again" });
  button.addEventListener("click", again);
  return button;
}

/** The errors, each detail once; places lead to where they are: `lead(pointer)`, if there is such, `leads(pointer)`. */
function errorList({ errors, errors_total = errors.length }, request, { lead, leads }) {
  const list = element("ul", { class: "errors" });
  for (const { detail, pointers } of groupFaults(errors.slice(0, MAX_ERRORS))) {
    const places = pointers.map((pointer) => placeButton(pointer, request, leads(pointer) ? lead : null));
    const text = element("span", { textContent: detail });
    if (places.length === 1) places[0].append(text);
    list.append(element("li", {}, ...places, places.length === 1 ? null : text));
  }
  const more = errors_total - Math.min(errors.length, MAX_ERRORS);
  if (more > 0) list.append(element("li", { textContent: `and ${count(more, "more", "more")}` }));
  return list;
}

/** The places in the request, for programmers. */
function pointersOf(errors, open) {
  const pointers = [
    ...new Set(errors.slice(0, MAX_ERRORS).map(({ pointer }) => pointer || "(whole request)")),
  ];
  const codes = pointers.map((pointer) => element("li", {}, element("code", { textContent: pointer })));
  const summary = element("summary", { textContent: "Places in the request" });
  return element(
    "details",
    { class: "pointers", open },
    summary,
    element("ul", { class: "plain" }, ...codes),
  );
}

/** A place with an error: a button that leads there, or plain if `lead` is null. */
function placeButton(pointer, request, lead) {
  const properties = { class: "error", "data-error": pointer };
  const place = element(lead ? "button" : "div", lead ? { ...properties, type: "button" } : properties);
  place.append(element("span", { class: "error-place" }, placeInWords(pointer, request)));
  if (lead) place.addEventListener("click", () => lead(pointer));
  return place;
}

/** The place that a pointer leads to, in words. */
function placeInWords(pointer, request) {
  const index = robotIndexOf(pointer);
  if (index !== null) return nameOf(request, index);
  const row = mapRowOf(pointer);
  if (row !== null) return `Row ${row + 1} of the map`;
  if (pointer.startsWith("/map")) return "Map";
  if (pointer.startsWith("/options")) return "Option";
  if (pointer.startsWith("/obstacles")) return "Obstacle";
  if (pointer.startsWith("/zones")) return "Zone";
  return "Request";
}
