// The faults of a request, for people: each told once, and where in the scene it is. Pure. Metres.

import { goalAt } from "./goals.js";
import { robotsOf } from "./listed.js";
import { mapRowOf, partsOf, robotIndexOf } from "./problem.js";

/** @import {Fault, Position, Request, Scene} from "./types.js" */

/**
 * The faults in groups of the same detail, in their order: [{detail, pointers}], each pointer once.
 * @param {Fault[]} errors
 */
export function groupFaults(errors) {
  const groups = new Map();
  for (const { pointer = "", detail } of errors) {
    if (!groups.has(detail)) groups.set(detail, new Set());
    groups.get(detail).add(pointer);
  }
  return [...groups].map(([detail, pointers]) => ({ detail, pointers: [...pointers] }));
}

/**
 * The disk of a robot that a fault points to or into: {x, y, radius}. It is at the goal if the fault points there,
 * otherwise at the start. Null if there is no disk. A robot that is too faulty to be drawn may still have a disk.
 * @param {Request} request
 * @param {Scene} scene
 */
export function diskOf(request, scene, pointer) {
  const robot = robotsOf(request)[robotIndexOf(pointer) ?? -1];
  const pose = goalAt(robot, partsOf(pointer).slice(2)) ?? robot?.start;
  if (!isPlace(pose)) return null;
  const radius = robot.radius ?? request.robot_defaults?.radius ?? 0;
  return { x: pose.x, y: pose.y, radius: radius > 0 ? radius : (scene.grid?.resolution ?? 1) / 2 };
}

/**
 * Where in the scene a fault is: at a robot, a row of the map, an obstacle or a zone. Null if it has no place there.
 * @param {Request} request
 * @param {Scene} scene
 * @returns {Position | null}
 */
export function placeOfFault(request, scene, pointer) {
  const disk = diskOf(request, scene, pointer);
  if (disk !== null) return disk;
  const row = mapRowOf(pointer);
  if (row !== null && scene.grid !== null) {
    const { bounds, resolution } = scene.grid;
    return { x: (bounds.left + bounds.right) / 2, y: bounds.top - (row + 0.5) * resolution };
  }
  const [list, index, member, entry] = partsOf(pointer);
  if (list === "obstacles") return firstPlace(request.obstacles?.[Number(index)]?.motion, member, entry);
  if (list === "zones") return firstPlace(request.zones?.[Number(index)]?.polygon, member, entry);
  return null;
}

/** The entry of a list that a pointer leads to. Otherwise, the first entry with a place; null if there is none. */
function firstPlace(entries, member, index) {
  const listed = Array.isArray(entries) ? entries : [];
  const named = ["motion", "polygon"].includes(member) ? listed[Number(index)] : undefined;
  return [named, ...listed].find(isPlace) ?? null;
}

const isPlace = (value) => Number.isFinite(value?.x) && Number.isFinite(value?.y);
