// The plan as an animation: the scene is recorded while it is played once, in the browser. It has no imports, so that it
// loads alone.

const LONGEST = 60; // seconds of the animation: longer plans are played faster
const FRAMES = 30; // a second
const REST = 0.6; // seconds at the end
const BITS = 6_000_000; // a second
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];

/** How fast a plan of this duration is recorded, plan seconds a second, if it is played at `speed`. */
export function recordingSpeed(duration, speed) {
  return Math.max(speed, duration / LONGEST);
}

/** Whether this browser can record. */
export function canRecord() {
  return typeof MediaRecorder === "function" && KINDS.some((kind) => MediaRecorder.isTypeSupported(kind));
}

/**
 * Records the canvas of the scene while the session's plan is played from its start; resolves to a Blob, or to null if
 * the signal aborts it. `progress(share)` is called meanwhile. The time before is restored.
 */
export async function recordPlan(session, stage, signal, progress) {
  const { player } = session;
  const before = player.time;
  session.pause();
  session.seek(0);
  stage.paint();
  const recorder = new MediaRecorder(stage.canvas.captureStream(FRAMES), {
    mimeType: KINDS.find((kind) => MediaRecorder.isTypeSupported(kind)),
    videoBitsPerSecond: BITS,
  });
  const parts = [];
  recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
  const stopped = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  recorder.start();
  // However busy the machine is: without a first picture no player opens the file, and without a last one it is over at
  // once.
  await encodePicture(recorder, stage, parts, signal);
  await playOnce(session, recordingSpeed(player.duration, player.speed), signal, progress);
  await encodePicture(recorder, stage, parts, signal);
  recorder.stop();
  await stopped;
  for (const track of recorder.stream.getTracks()) track.stop();
  session.seek(before);
  return signal.aborted ? null : new Blob(parts, { type: "video/webm" });
}

/** Paints until one more picture is among the parts. */
async function encodePicture(recorder, stage, parts, signal) {
  const size = () => parts.reduce((sum, part) => sum + part.size, 0);
  const before = size();
  while (size() === before && !signal.aborted) {
    stage.paint();
    recorder.requestData();
    await new Promise(requestAnimationFrame);
  }
}

function playOnce(session, speed, signal, progress) {
  const { duration } = session.player;
  return new Promise((resolve) => {
    const begun = performance.now();
    const step = () => {
      const passed = (performance.now() - begun) / 1000;
      session.seek(passed * speed);
      progress(Math.min(1, (passed * speed) / duration));
      if (signal.aborted || passed * speed >= duration + REST * speed) resolve(undefined);
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
}
