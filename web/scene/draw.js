// Paints a scene on a canvas. What does not move during playback (map, starts, goals, paths) is painted on a backdrop
// once for each camera. A frame is a copy of it, the robots and the overlays.

import { obstacleAt } from "../model/moving_obstacles.js";
import { robotPoseAt, robotRadiusAt, robotStateAt } from "../model/scene.js";
import { remainingPath } from "../model/timeline.js";
import { contextOf } from "../ui/dom.js";
import { HeatMap } from "./heat_map.js";
import { Backdrop } from "./backdrop.js";
import { MapRaster } from "./map_raster.js";
import { TravelMap } from "./travel_map.js";
import {
  drawAlternative,
  drawGoal,
  drawNumber,
  drawObstacle,
  drawPath,
  drawRobot,
  drawStart,
} from "./marks.js";
import { TagPlaces } from "./tag_places.js";
import { drawZone } from "./zone_marks.js";
import { robotColour } from "./palette.js";
import { toScreen } from "./view.js";

const GRID_LINES_FROM = 14; // pixels per cell: below, lines would only darken the floor
const NAME_ROOM = 40; // pixels beside a robot that its marks may take
const COMMITTED = { width: 3.5, alpha: 0.7 };
const CROSSING = { width: 1, alpha: 0.5, dashes: [2, 4] };
const OUTDATED = { width: 1.25, alpha: 0.5, dashes: [3, 4] };
const FAINT = { width: 1.25, alpha: 0.34 };
const MANY = 100; // robots: paths of more are fainter, or they would cover the map, and wait until the camera rests
const FAINTEST = 0.05;
const MAX_NAMED = 40; // marked robots whose names are shown: more would cover the map
const PART = 20; // robots, or poses of which they may choose, that are painted on the backdrop in one go

export class Painter {
  #canvas;
  #context;
  #backdrop = new Backdrop();
  #scene = /** @type {any} */ (null);
  #tracks = /** @type {any} */ (null);
  #theme = /** @type {any} */ (null);
  #look = /** @type {any} */ (null);
  #map = new MapRaster();
  #heat = new HeatMap();
  #travel = new TravelMap();
  #colours = [];

  constructor(canvas) {
    this.#canvas = canvas;
    this.#context = contextOf(canvas);
  }

  /** What to paint from now on, and how: see Stage.look. */
  show(scene, tracks, theme, look) {
    this.#map.show(scene.grid, [null, theme.wall]);
    this.#travel.show(look.travel, theme);
    this.#colours = scene.robots.map(({ index }) => robotColour(index, theme.robotLightness));
    this.#scene = scene;
    this.#tracks = tracks;
    this.#theme = theme;
    this.#look = look;
    this.#backdrop.drop();
  }

  /**
   * Paints the moment `time`. `marked`: the ids to bring out. `moving`: whether the camera is being moved. `overlays`
   * are functions (context, view). `view` has camera, viewport, ratio, time, tracks, marked, moving, theme, scale
   * (pixels per metre) and screen(point), all in CSS pixels.
   */
  paint({ camera, viewport, ratio, time, marked, moving, overlays }) {
    if (!this.#scene || viewport.width === 0) return;
    const width = Math.round(viewport.width * ratio);
    const height = Math.round(viewport.height * ratio);
    if (this.#canvas.width !== width || this.#canvas.height !== height) {
      this.#canvas.width = width;
      this.#canvas.height = height;
    }
    const context = this.#context;
    context.setTransform(1, 0, 0, 1, 0, 0);
    const picture = { camera, viewport, ratio, width, height };
    this.#backdrop.draw(context, picture, {
      moving: moving && this.#scene.robots.length > MANY,
      background: this.#theme.void,
      paint: (target) => this.#paintBackdrop(target, picture),
    });
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const screen = (point) => toScreen(camera, viewport, point);
    const view = {
      camera,
      viewport,
      ratio,
      time,
      tracks: this.#tracks,
      marked,
      moving,
      theme: this.#theme,
      scale: camera.scale,
      screen,
      tags: new TagPlaces(),
    };
    if (this.#look.paths === "remaining") this.#paintRemainingPaths(context, view);
    this.#paintMarkedPaths(context, view);
    this.#paintRobots(context, view);
    this.#paintObstacles(context, view);
    for (const overlay of overlays) overlay(context, view);
  }

  /** Yields now and then, see Backdrop. */
  *#paintBackdrop(context, { camera, viewport, ratio, width, height }) {
    context.fillStyle = this.#theme.void;
    context.fillRect(0, 0, width, height);
    if (this.#scene.grid) this.#paintMap(context, camera, viewport, ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    yield* this.#paintPlan(context, camera, viewport);
  }

  #paintMap(context, camera, viewport, ratio) {
    const { bounds, columns, rows, resolution } = this.#scene.grid;
    const corner = toScreen(camera, viewport, { x: bounds.left, y: bounds.top });
    const [left, top, cell] = [corner.x * ratio, corner.y * ratio, camera.scale * resolution * ratio];
    const [x, y] = [Math.round(left), Math.round(top)];
    const width = Math.round(left + columns * cell) - x;
    const height = Math.round(top + rows * cell) - y;
    context.fillStyle = this.#theme.floor;
    context.fillRect(x, y, width, height);
    this.#travel.draw(context, this.#scene.grid, { left: x, top: y, width, height });
    if (cell >= GRID_LINES_FROM * ratio) {
      paintGridLines(context, { left, top, cell, columns, rows }, this.#theme.grid);
    }
    this.#map.draw(context, left, top, cell);
    const line = Math.max(1, Math.round(ratio));
    context.strokeStyle = this.#theme.edge;
    context.lineWidth = line;
    context.strokeRect(x - line / 2, y - line / 2, width + line, height + line);
  }

  *#paintPlan(context, camera, viewport) {
    const screen = (point) => toScreen(camera, viewport, point);
    this.#paintHeat(context, camera, screen);
    for (const zone of this.#scene.zones) drawZone(context, this.#theme, zone, screen, camera.scale);
    const shown = this.#look.paths !== "none";
    for (const { motion } of this.#scene.obstacles) {
      if (shown) drawPath(context, motion.map(screen), this.#theme.ink, CROSSING);
    }
    yield* this.#paintAlternatives(context, camera, screen);
    const faint = pathLine(this.#scene.robots.length);
    for (const [at, robot] of this.#scene.robots.entries()) {
      if (at % PART === 0) yield;
      const track = this.#tracks.get(robot.id);
      const radius = robot.radius * camera.scale;
      const colour = this.#colours[at];
      const isOutdated = track.status === "outdated";
      const [line, ink] = isOutdated ? [OUTDATED, this.#theme.muted] : [faint, colour];
      if (this.#look.paths === "whole" || (shown && isOutdated))
        drawPath(context, track.path.map(screen), ink, line);
      if (shown) drawPath(context, robot.committed.map(screen), colour, COMMITTED);
      if (track.actions.length > 0) drawStart(context, screen(robot.start), radius, colour);
      this.#paintGoals(context, robot, track.chosen, radius, colour, screen);
    }
  }

  #paintHeat(context, { scale }, screen) {
    const { grid } = this.#scene;
    const { heat } = this.#look;
    if (grid === null || heat === "none") return;
    const colour = heat === "waiting" ? this.#theme.states.waiting : this.#theme.accent;
    this.#heat.draw(context, { grid, tracks: this.#tracks, kind: heat, colour, screen, scale });
  }

  /** The poses of which robots may choose. Each is painted once, because several robots may have the same pose. */
  *#paintAlternatives(context, { scale }, screen) {
    const painted = new Set();
    for (const { alternatives, radius } of this.#scene.robots) {
      for (const pose of alternatives.flat()) {
        const place = pose && `${pose.x} ${pose.y}`;
        if (place === null || painted.has(place)) continue;
        if (painted.size % PART === 0) yield;
        painted.add(place);
        drawAlternative(context, this.#theme, screen(pose), radius * scale);
      }
    }
  }

  /** The goals of a robot, including the poses that it has `chosen`. Several goals have their numbers, from 1. */
  #paintGoals(context, { via, goal }, chosen, radius, colour, screen) {
    const goals = [...via, goal].map((pose, at) => pose ?? chosen[at] ?? null);
    goals.forEach((each, at) => {
      if (each === null) return;
      drawGoal(context, screen(each), each.theta, radius, colour);
      if (goals.length > 1) drawNumber(context, this.#theme, screen(each), radius, colour, at + 1);
    });
  }

  #paintObstacles(context, { time, scale, screen }) {
    for (const obstacle of this.#scene.obstacles) {
      const place = obstacleAt(obstacle, time);
      if (place !== null) drawObstacle(context, this.#theme, screen(place), obstacle.radius * scale);
    }
  }

  #paintRemainingPaths(context, { time, screen }) {
    const faint = pathLine(this.#scene.robots.length);
    this.#scene.robots.forEach((robot, at) => {
      const { actions, cost } = this.#tracks.get(robot.id);
      if (cost === null || time >= cost) return;
      const rest = remainingPath(actions, robot.start, time).map(screen);
      drawPath(context, rest, this.#colours[at], faint);
    });
  }

  #paintMarkedPaths(context, { time, marked, screen }) {
    this.#scene.robots.forEach((robot, at) => {
      if (!marked.has(robot.id)) return;
      const track = this.#tracks.get(robot.id);
      if (track.actions.length > 0 && track.path.length > 1) {
        const rest = remainingPath(track.actions, robot.start, time).map(screen);
        drawPath(context, rest, this.#colours[at], { width: 3, alpha: 0.95 });
      } else if (robot.goal && track.status !== "planned") {
        const stops = [robot.start, ...robot.via.filter((goal) => goal !== null), robot.goal];
        drawPath(context, stops.map(screen), this.#colours[at], {
          width: 1.5,
          alpha: 0.8,
          dashes: [3, 5],
        });
      }
    });
  }

  #paintRobots(context, view) {
    const { robots } = this.#scene;
    for (let at = 0; at < robots.length; at += 1) {
      if (!view.marked.has(robots[at].id)) this.#paintRobot(context, view, at, null);
    }
    for (let at = 0; at < robots.length; at += 1) {
      if (!view.marked.has(robots[at].id)) continue;
      this.#paintRobot(context, view, at, view.marked.size <= MAX_NAMED ? robots[at].id : "");
    }
  }

  /** `name`: the text beside the robot at this index of the scene, "" for a ring alone, or null. */
  #paintRobot(context, { viewport, time, scale, screen, tags }, at, name) {
    const robot = this.#scene.robots[at];
    const track = this.#tracks.get(robot.id);
    const pose = robotPoseAt(robot, track, time);
    const centre = screen(pose);
    const radius = robotRadiusAt(robot, track, time) * scale;
    const beyond = radius + NAME_ROOM;
    if (centre.x < -beyond || centre.x > viewport.width + beyond) return;
    if (centre.y < -beyond || centre.y > viewport.height + beyond) return;
    const byState = this.#look.colours === "state" || track.status === "outdated"; // which has no colour of its own
    const state = byState ? robotStateAt(track, time) : null;
    drawRobot(context, this.#theme, {
      centre,
      theta: pose.theta,
      radius,
      colour: state === null ? this.#colours[at] : this.#theme.states[state],
      label: robot.label,
      state,
      unplanned: track.status === "unplanned",
      name,
      tags,
    });
  }
}

/** The line of the path of one of so many robots, see drawPath. */
export function pathLine(robots) {
  if (robots <= MANY) return FAINT;
  return { width: 1, alpha: Math.max(FAINTEST, (FAINT.alpha * MANY) / robots) };
}

function paintGridLines(context, { left, top, cell, columns, rows }, colour) {
  context.fillStyle = colour;
  const right = Math.round(left + columns * cell);
  const bottom = Math.round(top + rows * cell);
  for (let column = 1; column < columns; column += 1) {
    context.fillRect(Math.round(left + column * cell), Math.round(top), 1, bottom - Math.round(top));
  }
  for (let row = 1; row < rows; row += 1) {
    context.fillRect(Math.round(left), Math.round(top + row * cell), right - Math.round(left), 1);
  }
}
