// What can be dragged in the scene: disks, goals and, for the selected robot, handles that
// rotate its start and goal. A part is {robot, pose: "start" or "goal", turns: whether it is a handle, place:
// {x, y}}.

import { ring } from "../scene/marks.js";

const STEM = 22; // pixels from a disk's rim to its handle
const LONGER = 48; // additional pixels for the goal's handle if it would cover the start's
const NAME = 28; // pixels above a disk that its name may occupy
const KNOB = 6; // pixels, the radius of a handle
const PICK = { mouse: 10, touch: 22 }; // pixels around a handle that pick it

/** How far from a handle a pointer picks it, metres; `event` gives its type, a mouse for null. */
export const reachOf = (event, scale) => (event?.pointerType === "touch" ? PICK.touch : PICK.mouse) / scale;

/**
 * The part at a world point, or null; `event` gives the type of pointer; with Shift, goals come before
 * starts. A start is where the robot starts, wherever the robot is under way.
 */
export function partAt(world, { session, stage, chosen, event }) {
  const reach = reachOf(event, stage.scale);
  for (const pose of chosen ? posesOf(chosen) : []) {
    const { knob } = handleOf(chosen, pose, { scale: stage.scale, time: session.player.time });
    if (Math.hypot(knob.x - world.x, knob.y - world.y) > reach) continue;
    return { robot: chosen, pose, turns: true, place: knob };
  }
  const start = part(
    stage.diskAt(world, (robot) => robot.start),
    "start",
  );
  const goal = part(
    stage.diskAt(world, (robot) => robot.goal),
    "goal",
  );
  if (event?.pointerType === "touch" && start && goal) return nearer(world, start, goal);
  return event?.shiftKey ? (goal ?? start) : (start ?? goal);
}

/** The one of two parts that is nearer to a point: a finger reaches both where they are near to each other. */
function nearer({ x, y }, one, other) {
  const [near, far] = [one, other].map(({ place }) => Math.hypot(place.x - x, place.y - y));
  return near <= far ? one : other;
}

/** The part for a disk ({robot, place} or null) at one of the poses, or null. */
const part = (disk, pose) => disk && { ...disk, pose, turns: false };

const posesOf = (robot) => (robot.goal ? ["goal", "start"] : ["start"]);

/**
 * The handle that rotates a pose: {rim, knob}, the world points of its stem. A goal of any
 * heading has it to the right. At time 0 the robot is at its start, with its name above it.
 */
function handleOf(robot, pose, { scale, time }) {
  const { x, y, theta } = robot[pose];
  const apart = robot.goal
    ? Math.hypot(robot.goal.x - robot.start.x, robot.goal.y - robot.start.y)
    : Infinity;
  const longer = pose === "goal" && apart * scale < 2 * STEM ? LONGER : 0;
  const beyondName = pose === "start" && time === 0 && Math.sin(theta) > 0.7 ? NAME : 0;
  const at = (pixels) => {
    const distance = robot.radius + pixels / scale;
    return { x: x + Math.cos(theta ?? 0) * distance, y: y + Math.sin(theta ?? 0) * distance };
  };
  return { rim: at(beyondName), knob: at(beyondName + longer + STEM) };
}

/** Paints the handles of the selected robot. */
export function paintHandles(context, view, robot) {
  const { screen, theme } = view;
  context.save();
  context.lineWidth = 2;
  for (const pose of posesOf(robot)) {
    const { rim, knob } = handleOf(robot, pose, view);
    const [from, to] = [screen(rim), screen(knob)];
    context.strokeStyle = theme.accent;
    context.setLineDash(robot[pose].theta === null ? [2, 3] : []);
    context.beginPath();
    context.moveTo(from.x, from.y);
    context.lineTo(to.x, to.y);
    context.stroke();
    context.setLineDash([]);
    context.fillStyle = pose === "start" ? theme.accent : theme.floor;
    context.beginPath();
    context.arc(to.x, to.y, KNOB, 0, 2 * Math.PI);
    context.fill();
    context.strokeStyle = pose === "start" ? theme.floor : theme.accent;
    context.stroke();
  }
  context.restore();
}

/** Rings the part that a press would drag. */
export function paintPart(context, { scale, screen, theme }, { robot, turns, place }) {
  const radius = turns ? KNOB + 3 : Math.max(robot.radius * scale, 4) + 4;
  ring(context, screen(place), radius, theme.accent, { width: 2, alpha: 1, dashes: [] });
}
