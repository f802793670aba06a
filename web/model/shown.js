// What is shown of a request and its answer: the scene, and what each robot does in it at a time (seconds).

import { readScene, readTracks, robotPoseAt, robotRadiusAt, robotStateAt } from "./scene.js";

/** @import {Answer, Robot, Scene, Track} from "./types.js" */

export class Shown {
  /** @type {Scene} */
  scene = readScene(null);
  /** @type {Map<string, Robot>} */
  robots = new Map(); // of the scene, by id
  /** @type {Map<string, Track>} */
  tracks = new Map(); // by id
  /** @type {Answer | null} */
  answer = null;
  /** @type {Set<string> | null} */
  outdated = null; // if the answer is of the request before its edits: the robots whose plans no longer hold

  /** To be followed by showAnswer. */
  showRequest(request) {
    this.scene = readScene(request, this.scene);
    this.robots = new Map(this.scene.robots.map((robot) => [robot.id, robot]));
  }

  showAnswer(answer, outdated) {
    this.answer = answer;
    this.outdated = outdated;
    this.tracks = readTracks(this.scene, answer, outdated);
  }

  /** The robot of an id in the scene, or null. */
  robot(id) {
    return this.robots.get(id) ?? null;
  }

  /** The pose of a robot at a time; null if there is no such robot. */
  poseOf(id, time) {
    const robot = this.robot(id);
    return robot && robotPoseAt(robot, this.tracks.get(id), time);
  }

  /** The radius of a robot at a time, metres; null if there is no such robot. */
  radiusOf(id, time) {
    const robot = this.robot(id);
    return robot && robotRadiusAt(robot, /** @type {Track} */ (this.tracks.get(id)), time);
  }

  /** The state of a robot at a time, one word; null if there is no such robot. */
  stateOf(id, time) {
    return this.tracks.has(id) ? robotStateAt(this.tracks.get(id), time) : null;
  }
}
