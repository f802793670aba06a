// The form that begins a request of one's own: an empty map to draw on.

import { faultOfSize, newMap } from "../model/edit_map.js";
import { byId, setText } from "../ui/dom.js";

/** `begin(request)` opens what is made. */
export function watchNewMapForm(session, begin) {
  const form = byId("new-map");
  const fault = byId("new-map-fault");
  const number = (id) => byId(id).valueAsNumber;
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const [columns, rows, resolution] = ["new-columns", "new-rows", "new-resolution"].map(number);
    const wrong = resolution > 0 ? faultOfSize(columns, rows, session.limits) : "A cell is larger than 0 m.";
    setText(fault, wrong ?? "");
    if (wrong !== null) return;
    begin(newMap({ columns, rows, resolution, walled: byId("new-walled").checked }));
    session.say(`A new map of ${columns} columns and ${rows} rows.`);
  });
}
