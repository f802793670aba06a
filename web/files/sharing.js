// What the Save menu offers for others to look at: a picture, an animation, a page of its own. The last two are loaded
// when they are asked for.

import { planFile } from "../model/plan_file.js";
import { ScenePicture } from "../scene/scene_picture.js";
import { byId, setText } from "../ui/dom.js";
import { saveBlob } from "./downloads.js";

const FINE = 2; // pixels of the picture a pixel of the page, at least
const FAILED = "This failed. Is the service reachable and the browser up to date?";

/** `load` has animation() and page(), which resolve to the modules; `stem()` is the name of files. */
export function watchSharing(session, stage, load, stem) {
  const [picture, animation, page] = ["save-picture", "save-animation", "save-page"].map(byId);
  const note = byId("save-note");
  const scene = new ScenePicture(stage);
  const tell = (text) => {
    note.hidden = text === "";
    setText(note, text);
  };
  /** @type {AbortController | null} */
  let recording = null;
  session.on("answer", () => {
    recording?.abort();
    picture.disabled = session.request === null;
    for (const button of [animation, page]) button.disabled = !session.hasPlan;
  });
  picture.addEventListener("click", () => savePicture(scene, stem()));
  page.addEventListener("click", async () => {
    const made = await load.page().then(
      (loaded) => pageOf(loaded, session),
      () => null,
    );
    tell(made === null ? FAILED : "");
    if (made !== null) saveBlob(`${stem()}.html`, new Blob([made], { type: "text/html" }));
  });
  animation.addEventListener("click", async () => {
    if (recording !== null) {
      recording.abort();
      return;
    }
    recording = new AbortController();
    const label = animation.firstChild;
    const words = label.textContent;
    const begun = performance.now();
    const progress = (share) => {
      label.textContent = `Recording, ${Math.round(share * 100)} %: stop `;
      tell(share > 0 ? leftInWords((performance.now() - begun) / 1000, share, session.player.duration) : "");
    };
    const recorded = await load.animation().then(
      ({ canRecord, recordPlan }) =>
        canRecord() ? recordPlan(session, scene, recording?.signal, progress) : undefined,
      () => undefined,
    );
    recording = null;
    label.textContent = words;
    tell(recorded === undefined ? FAILED : "");
    if (recorded) saveBlob(`${stem()}.webm`, recorded);
  });
}

/** How long recording goes on, in words, after some seconds and a share of it; `duration` is the plan's. */
export function leftInWords(passed, share, duration) {
  const whole = passed / share;
  const left = `About ${Math.max(1, Math.round(whole - passed))} s left`;
  return whole > duration ? `${left}: longer than the plan, as this computer draws slowly.` : `${left}.`;
}

function pageOf({ sharedPage }, { name, request, answer }) {
  return sharedPage(name, planFile(request, answer));
}

/** Saves the scene as it is seen, with at least twice the pixels of the page. */
function savePicture(scene, stem) {
  const canvas = scene.paint(Math.max(FINE, window.devicePixelRatio || 1)); // with all pending changes
  canvas.toBlob((blob) => saveBlob(`${stem}.png`, blob), "image/png");
  scene.paint();
}
