import assert from "node:assert/strict";
import { test } from "node:test";

import { eventTimes, nextEvent, Player } from "../../../web/model/playback.js";

function playing(duration) {
  const player = new Player();
  player.reset(duration);
  player.play();
  player.tick(100);
  return player;
}

test("time passes at the chosen speed", () => {
  const player = playing(60);
  player.tick(101.5);
  assert.equal(player.time, 1.5);
  player.speed = 4;
  player.tick(102);
  assert.equal(player.time, 3.5);
});

test("a finished plan rests at its end", () => {
  const player = playing(2);
  player.tick(105);
  assert.equal(player.time, 2);
  assert.equal(player.playing, false);
});

test("a looping plan starts over and keeps playing", () => {
  const player = playing(2);
  player.loop = true;
  player.tick(102.5);
  assert.equal(player.time, 0.5);
  assert.equal(player.playing, true);
});

test("playing at the end starts from the beginning", () => {
  const player = playing(2);
  player.tick(105);
  player.play();
  assert.equal(player.time, 0);
});

test("time during a pause does not count", () => {
  const player = playing(60);
  player.tick(101);
  player.pause();
  player.tick(150);
  player.play();
  player.tick(200);
  player.tick(201);
  assert.equal(player.time, 2);
});

test("time while the page is hidden does not count", () => {
  const player = playing(60);
  player.tick(101);
  player.skip();
  player.tick(150);
  player.tick(151);
  assert.equal(player.time, 2);
});

test("seeking stays within the plan", () => {
  const player = playing(10);
  player.seek(99);
  assert.equal(player.time, 10);
  player.seek(-1);
  assert.equal(player.time, 0);
});

test("a plan without duration does not play", () => {
  const player = new Player();
  player.reset(0);
  player.play();
  assert.equal(player.playing, false);
});

const action = (t_start, t_end) => ({ t_start, t_end });

test("the events of some tracks are the ends of all their actions, each once", () => {
  const tracks = [
    { actions: [action(0, 1), action(1, 3)] },
    { actions: [action(0, 2), action(2, 3 + 1e-9)] },
  ];
  assert.deepEqual(eventTimes(tracks), [0, 1, 2, 3]);
});

test("robots that do nothing have no events", () => {
  assert.deepEqual(eventTimes([{ actions: [] }]), []);
});

test("steps go to the next or previous event, and stay if there is none", () => {
  const times = [0, 1, 2.5];
  assert.equal(nextEvent(times, 0.4, 1), 1);
  assert.equal(nextEvent(times, 1, 1), 2.5);
  assert.equal(nextEvent(times, 1 - 1e-9, 1), 2.5);
  assert.equal(nextEvent(times, 2.5, 1), 2.5);
  assert.equal(nextEvent(times, 2.5, -1), 1);
  assert.equal(nextEvent(times, 0, -1), 0);
  assert.equal(nextEvent([], 3, 1), 3);
});
