// What the main thread of a page does, by Chromium's tracing: its tasks, and its frames.

const CATEGORIES = ["devtools.timeline", "disabled-by-default-devtools.timeline"];
const SCRIPT = [
  "FireAnimationFrame",
  "FunctionCall",
  "EventDispatch",
  "TimerFire",
  "RunMicrotasks",
  "EvaluateScript",
];
const STYLE = ["UpdateLayoutTree", "Layout"];

/** The events of the page's main thread while `steps()` runs. */
export async function traced(page, steps) {
  const client = await page.context().newCDPSession(page);
  const events = [];
  client.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  const complete = new Promise((resolve) => client.once("Tracing.tracingComplete", resolve));
  await client.send("Tracing.start", {
    transferMode: "ReportEvents",
    traceConfig: { includedCategories: CATEGORIES },
  });
  await steps();
  await client.send("Tracing.end");
  await complete;
  await client.detach();
  return ofMainThread(events);
}

/** The events of the main thread that runs most, in their order. */
function ofMainThread(events) {
  const threads = events.filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain");
  const own = threads.map(({ pid, tid }) => events.filter((event) => event.pid === pid && event.tid === tid));
  const used = (list) => sum(list.filter(({ name }) => name === "RunTask"));
  const [main] = own.sort((a, b) => used(b) - used(a));
  return main.sort((a, b) => a.ts - b.ts);
}

const sum = (events) => events.reduce((total, { tdur = 0 }) => total + tdur, 0) / 1000;

/** The longest task, milliseconds: {cpu, wall}. */
export function longestTask(events) {
  const tasks = events.filter(({ name }) => name === "RunTask");
  const most = (key) => Math.max(0, ...tasks.map((task) => task[key] ?? 0)) / 1000;
  return { cpu: most("tdur"), wall: most("dur") };
}

/**
 * The CPU time of each frame, milliseconds: [{script, style, all}], for scripts, for style and layout, and for all
 * tasks with painting. A frame ends with its commit.
 */
export function framesOf(events) {
  const ends = events.filter(({ name }) => name === "Commit").map(({ ts, dur }) => ts + dur);
  const [scripts, styles] = [SCRIPT, STYLE].map((names) => outermost(events, names));
  const tasks = outermost(events, ["RunTask"]);
  return ends.slice(1).map((end, at) => {
    const within = (list) => sum(list.filter(({ ts }) => ts >= ends[at] && ts < end));
    return { script: within(scripts), style: within(styles), all: within(tasks) };
  });
}

/** The events of these names that are in no other of them. */
function outermost(events, names) {
  let end = -Infinity;
  return events.filter(({ name, ts, dur, tdur }) => {
    if (!names.includes(name) || tdur === undefined || ts < end) return false;
    end = ts + dur;
    return true;
  });
}
