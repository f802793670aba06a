// Reads what takes long to draw of a request, before it is shown: maps that are not rows, large maps, masks of zones.

import { asRows, maskOf, rememberMask, rememberRows } from "../model/drawn_map.js";
import { prepareCells } from "../model/grid_cells.js";
import { zonesOf } from "../model/listed.js";

/** `work` has the functions of MAP_WORK; `nextTask()` lets the browser paint and answer people meanwhile. */
export async function prepareRequest(request, work, nextTask) {
  await Promise.all([
    prepareMap(request?.map, work),
    ...masksOf(request).map((mask) => prepareMask(mask, request?.map, work)),
  ]);
  await prepareCells(asRows(request?.map)?.rows ?? [], nextTask);
}

async function prepareMap(map, work) {
  if (!isObject(map) || asRows(map) !== null) return;
  const rows = await work.readRequestMap(map);
  if (rows !== null) rememberRows(map, rows);
}

/** The masks of a request's zones that were not read yet. */
function masksOf(request) {
  return zonesOf(request)
    .map((zone) => zone?.mask)
    .filter((mask) => isObject(mask) && maskOf(mask) === null);
}

async function prepareMask(mask, map, work) {
  const cells = await work.readMask(mask, map);
  if (cells !== null) rememberMask(mask, cells);
}

const isObject = (value) => value !== null && typeof value === "object";
