// A tab whose panel is loaded when it is first opened.

import { byId, element } from "../ui/dom.js";

/** `load()` resolves to a function that fills the panel: fill(panel). */
export function watchLazyTab(tabs, name, load) {
  const panel = byId(`panel-${name}`);
  let begun = false;
  const begin = async () => {
    begun = true;
    panel.replaceChildren(element("p", { class: "facts", textContent: "Loading…" }));
    const fill = await load().catch(() => null);
    if (fill === null) {
      const again = element("button", { type: "button", class: "quiet", textContent: "Try again" });
      again.addEventListener("click", begin);
      const fault = "This part of the page did not load. Is the service running and reachable?";
      panel.replaceChildren(element("p", { class: "fault", textContent: fault }), again);
      return;
    }
    panel.replaceChildren();
    fill(panel);
  };
  tabs.onChange(() => {
    if (!begun && tabs.chosen === `tab-${name}`) begin();
  });
}
