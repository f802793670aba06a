// The plan as an animation, made in the browser. It is encoded picture by picture, which takes less time than to play
// it. If the browser has no encoder of pictures, it is recorded while it is played once.

import { writeWebm } from "./webm.js";

const LONGEST = 60; // seconds of the animation: longer plans are played faster
const FRAMES = 30; // a second
const REST = 0.6; // seconds at the end
const BITS = 6_000_000; // a second
const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
const CODEC = { name: "vp8", inWebm: "V_VP8" };
const KEY_EVERY = 5 * FRAMES; // pictures: players seek to these
const MAX_QUEUED = 8; // pictures that wait for the encoder
const TURN_MS = 30; // of work until the browser may answer people

/** How fast a plan of this duration is recorded, plan seconds a second, if it is played at `speed`. */
export function recordingSpeed(duration, speed) {
  return Math.max(speed, duration / LONGEST);
}

/** Whether this browser can record. */
export function canRecord() {
  return typeof MediaRecorder === "function" && KINDS.some((kind) => MediaRecorder.isTypeSupported(kind));
}

/**
 * Makes an animation of the session's plan; resolves to a Blob, or to null if the signal aborts it. `picture`: see
 * ScenePicture. `progress(share)` is called meanwhile. The time before is restored.
 */
export async function recordPlan(session, picture, signal, progress) {
  const { time } = session.player;
  session.pause();
  session.seek(0);
  const canvas = picture.paint();
  const settings = {
    codec: CODEC.name,
    width: canvas.width,
    height: canvas.height,
    bitrate: BITS,
    framerate: FRAMES,
  };
  const parts = (await canEncode(settings))
    ? await encodePlan(session, picture, settings, signal, progress)
    : await playPlan(session, picture, signal, progress);
  session.seek(time);
  return signal.aborted ? null : new Blob(parts, { type: "video/webm" });
}

async function canEncode(settings) {
  if (typeof VideoEncoder !== "function") return false;
  return VideoEncoder.isConfigSupported(settings).then(
    ({ supported }) => supported === true,
    () => false,
  );
}

/** Encodes the pictures of the plan, as fast as that goes. */
async function encodePlan(session, picture, settings, signal, progress) {
  const { player } = session;
  const speed = recordingSpeed(player.duration, player.speed);
  const length = player.duration / speed + REST;
  const count = Math.ceil(length * FRAMES);
  /** @type {import("./webm.js").EncodedPicture[]} */
  const pictures = [];
  const encoding = encoderOf(settings, pictures);
  let turn = performance.now();
  for (let at = 0; at < count && !signal.aborted; at += 1) {
    player.seek((at / FRAMES) * speed);
    await encoding.encode(picture.paint(), at);
    if (performance.now() - turn < TURN_MS) continue;
    session.seek(player.time);
    progress(at / count);
    await new Promise(requestAnimationFrame);
    turn = performance.now();
  }
  await encoding.end(signal.aborted);
  const { width, height } = settings;
  return writeWebm({ codec: CODEC.inWebm, width, height, duration: length * 1000 }, pictures);
}

/** An encoder that appends to `pictures`; what it is asked rejects if it fails. */
function encoderOf(settings, pictures) {
  let fail = /** @type {(error: any) => void} */ (() => {});
  const failure = new Promise((_, reject) => (fail = reject));
  failure.catch(() => {}); // it is awaited with what is asked
  const encoder = new VideoEncoder({
    output: (chunk) => {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      pictures.push({ data, time: Math.round(chunk.timestamp / 1000), isKey: chunk.type === "key" });
    },
    error: fail,
  });
  encoder.configure(settings);
  return {
    async encode(canvas, at) {
      const frame = new VideoFrame(canvas, { timestamp: (at * 1e6) / FRAMES });
      encoder.encode(frame, { keyFrame: at % KEY_EVERY === 0 });
      frame.close();
      while (encoder.encodeQueueSize > MAX_QUEUED) {
        await Promise.race([
          failure,
          new Promise((done) => encoder.addEventListener("dequeue", done, { once: true })),
        ]);
      }
    },
    async end(isAborted) {
      if (!isAborted) await Promise.race([failure, encoder.flush()]);
      encoder.close();
    },
  };
}

/** Records the scene while the plan is played. */
async function playPlan(session, picture, signal, progress) {
  const { player } = session;
  const recorder = new MediaRecorder(picture.paint().captureStream(FRAMES), {
    mimeType: KINDS.find((kind) => MediaRecorder.isTypeSupported(kind)),
    videoBitsPerSecond: BITS,
  });
  const parts = [];
  recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
  const stopped = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  recorder.start();
  // A first and a last picture are recorded, however busy the machine is. Without a first picture, no player opens the
  // file. Without a last picture, it is over at once.
  await recordPicture(recorder, picture, parts, signal);
  await playOnce(session, picture, recordingSpeed(player.duration, player.speed), signal, progress);
  await recordPicture(recorder, picture, parts, signal);
  recorder.stop();
  await stopped;
  for (const track of recorder.stream.getTracks()) track.stop();
  return parts;
}

/** Paints until one more picture is among the parts. */
async function recordPicture(recorder, picture, parts, signal) {
  const size = () => parts.reduce((sum, part) => sum + part.size, 0);
  const before = size();
  while (size() === before && !signal.aborted) {
    picture.paint();
    recorder.requestData();
    await new Promise(requestAnimationFrame);
  }
}

function playOnce(session, picture, speed, signal, progress) {
  const { duration } = session.player;
  return new Promise((resolve) => {
    const begun = performance.now();
    const step = () => {
      const passed = (performance.now() - begun) / 1000;
      session.seek(passed * speed);
      picture.paint();
      progress(Math.min(1, (passed * speed) / duration));
      if (signal.aborted || passed * speed >= duration + REST * speed) resolve(undefined);
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  });
}
