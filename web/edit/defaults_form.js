// The form of what robots have that do not say it themselves.

import { setDefault } from "../model/edit_robots.js";
import { byId } from "../ui/dom.js";
import { NumberField } from "../ui/number_field.js";
import { ROBOT_NUMBERS } from "./robot_form.js";

export function watchDefaultsForm(session) {
  const fields = ROBOT_NUMBERS.map(({ name, label, unit }) => {
    const take = (value) => session.edit(setDefault(session.request, name, value), `default ${name}`);
    const field = new NumberField({ label, unit, take, settle: () => session.endGesture() });
    field.input.dataset.pointer = `/robot_defaults/${name}`;
    return [name, field];
  });
  byId("default-numbers").append(...fields.map(([, { element }]) => element));
  session.on("request", () => {
    for (const [name, field] of fields) {
      field.show(session.request?.robot_defaults?.[name], { placeholder: "none" });
    }
  });
}
