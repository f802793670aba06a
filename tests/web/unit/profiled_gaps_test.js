// Gaps between robots whose speed changes: against positions that are worked out without code of the page.

import assert from "node:assert/strict";
import { test } from "node:test";

import { clearanceOf } from "../../../web/model/clearance.js";
import { firstOverlap, motionOf } from "../../../web/model/motion.js";
import { inertiaOf, withChanges } from "../../../web/model/profile.js";
import { RelativeMotion } from "../../../web/model/relative_motion.js";
import { expectedPose } from "../support/expected_pose.js";

const FASTEST = 3; // m/s

/** Numbers in [0, 1) that look random and are the same in every run. */
function numbers(seed) {
  let state = seed;
  return () => {
    state = (state * 16807) % 2147483647;
    return state / 2147483647;
  };
}

/**
 * A robot and its actions: translations, each of which may begin and end at speed, waits and rotations; it may be under way
 * at first.
 */
function wanderer(next) {
  const robot = {
    radius: 0.1 + 0.4 * next(),
    start: { x: 6 * next(), y: 6 * next(), theta: 0 },
    linear_acceleration: 0.2 + 2 * next(),
    linear_deceleration: 0.2 + 2 * next(),
    angular_acceleration: 1,
  };
  const actions = [];
  const place = { t: 0, pose: robot.start, speed: next() < 0.5 ? FASTEST * next() : 0 };
  const go = (type, duration, to, profile) => {
    const { t, pose } = place;
    actions.push({ type, t_start: t, t_end: t + duration, from: pose, to, ...(profile ? { profile } : {}) });
    [place.t, place.pose] = [t + duration, to];
  };
  const heading = (theta) => ({ ...place.pose, theta });
  for (let leg = 0; leg < 6; leg += 1) {
    if (place.speed === 0) {
      if (next() < 0.4) go("wait", 2 * next(), place.pose);
      go("rotate", 2 * next(), heading(2 * Math.PI * (next() - 0.5)));
    }
    const profile = { start: place.speed, cruise: 0.1 + (FASTEST - 0.1) * next(), end: 0 };
    profile.cruise = Math.max(profile.cruise, profile.start);
    profile.end = next() < 0.4 ? profile.cruise * next() : 0;
    const rise = (profile.cruise - profile.start) / robot.linear_acceleration;
    const fall = (profile.cruise - profile.end) / robot.linear_deceleration;
    const cruise = next() < 0.3 ? 0 : 2 * next();
    const way =
      ((profile.start + profile.cruise) * rise + (profile.cruise + profile.end) * fall) / 2 +
      profile.cruise * cruise;
    const { x, y, theta } = place.pose;
    const to = { x: x + way * Math.cos(theta), y: y + way * Math.sin(theta), theta };
    go("translate", rise + cruise + fall, to, profile);
    place.speed = profile.end;
  }
  return { robot, actions };
}

/** Another robot that crosses the way of the first, so that the two come near. */
function crossing(next, { robot, actions }) {
  const other = wanderer(next);
  const t = 2 + 3 * next();
  const [here, there] = [
    expectedPose(robot.start, actions, t, robot),
    expectedPose(other.robot.start, other.actions, t, other.robot),
  ];
  const [x, y] = [here.x - there.x + next() - 0.5, here.y - there.y + next() - 0.5];
  const moved = (pose) => ({ ...pose, x: pose.x + x, y: pose.y + y });
  other.robot.start = moved(other.robot.start);
  other.actions = other.actions.map((each) => ({ ...each, from: moved(each.from), to: moved(each.to) }));
  return other;
}

const motionAlong = ({ robot, actions }, radii = []) =>
  motionOf(robot, withChanges(actions, inertiaOf(robot)), radii);

/** The gap of two at t. */
function gapAt(one, other, t) {
  const [a, b] = [one, other].map(({ robot, actions }) => expectedPose(robot.start, actions, t, robot));
  return Math.hypot(b.x - a.x, b.y - a.y) - one.robot.radius - other.robot.radius;
}

const endOf = (...all) => Math.max(...all.map(({ actions }) => actions.at(-1).t_end));
const STEP = 0.002; // seconds: in half of it, two robots approach by no more than STEP * FASTEST

test("the least gap of profiled motions is at most that of samples, by no more than robots move between two", () => {
  const next = numbers(11);
  for (let pair = 0; pair < 60; pair += 1) {
    const one = wanderer(next);
    const other = crossing(next, one);
    const curve = clearanceOf([motionAlong(one), motionAlong(other)], 1 + Math.floor(40 * next()));
    const least = curve.gap[curve.least];
    assert.ok(Math.abs(gapAt(one, other, curve.t[curve.least]) - least) < 1e-9, `pair ${pair}`);
    let sampled = Infinity;
    for (let t = 0; t <= endOf(one, other) + STEP; t += STEP)
      sampled = Math.min(sampled, gapAt(one, other, t));
    assert.ok(least <= sampled + 1e-9, `pair ${pair}: ${least} and ${sampled}`);
    assert.ok(least >= sampled - STEP * FASTEST, `pair ${pair}: ${least} and ${sampled}`);
  }
});

test("the least gap is a minimum: around its moment, finer and finer samples are not below it", () => {
  const next = numbers(12);
  for (let pair = 0; pair < 200; pair += 1) {
    const one = wanderer(next);
    const other = crossing(next, one);
    const curve = clearanceOf([motionAlong(one), motionAlong(other)]);
    const least = curve.gap[curve.least];
    for (let step = 1; step > 1e-9; step /= 2) {
      for (const t of [curve.t[curve.least] - step, curve.t[curve.least] + step])
        assert.ok(gapAt(one, other, Math.max(0, t)) >= least - 1e-9, `pair ${pair}`);
    }
  }
});

test("each window has the least gap of its own", () => {
  const next = numbers(13);
  const one = wanderer(next);
  const other = crossing(next, one);
  const coarse = clearanceOf([motionAlong(one), motionAlong(other)], 1);
  const fine = clearanceOf([motionAlong(one), motionAlong(other)], 5000);
  assert.ok(Math.abs(coarse.gap[coarse.least] - fine.gap[fine.least]) < 1e-9);
  fine.t.forEach((t, k) => assert.ok(Math.abs(gapAt(one, other, t) - fine.gap[k]) < 1e-9, `${t} s`));
});

test("the first overlap is where two come into contact, and not before", () => {
  const next = numbers(14);
  let found = 0;
  for (let pair = 0; pair < 200; pair += 1) {
    const one = wanderer(next);
    const other = crossing(next, one);
    const end = endOf(one, other);
    const t = firstOverlap(motionAlong(one), motionAlong(other), 0, end);
    for (let at = 0; at < (t ?? end); at += 0.02) assert.ok(gapAt(one, other, at) >= -1e-6, `pair ${pair}`);
    if (t === null || t === 0) continue;
    found += 1;
    assert.ok(Math.abs(gapAt(one, other, t)) < 1e-6, `pair ${pair}`);
  }
  assert.ok(found > 50, `${found} of 200 overlap`);
});

test("a radius counts from its time on, also from the end of all motion on", () => {
  const at = (x) => ({ x, y: 0, theta: 0 });
  const still = { robot: { radius: 0.5, start: at(0) }, actions: [] };
  const near = { robot: { radius: 0.5, start: at(3) }, actions: [] };
  near.actions.push({ type: "wait", t_start: 0, t_end: 2, from: at(3), to: at(3), goal: 0 });
  for (const t of [1, 2, 5]) {
    const curve = clearanceOf([motionAlong(still), motionAlong(near, [{ t, radius: 1.25 }])], 7);
    assert.ok(Math.abs(curve.gap[curve.least] - 1.25) < 1e-12, `from ${t} s on`);
    assert.equal(curve.t[curve.least], t);
    assert.equal(Math.max(...curve.gap), 2);
  }
});

test("parabolas of all kinds: no sample is nearer than the nearest share, by more than they move between two", () => {
  const next = numbers(15);
  const sizes = [0, 0, 1e-12, 1e-6, 1, 1, 30];
  const part = () => (next() - 0.5) * sizes[Math.floor(sizes.length * next())];
  const SAMPLES = 500;
  for (let kind = 0; kind < 3000; kind += 1) {
    const [x, y] = [part(), part()];
    const [wayX, wayY] = [part(), part()];
    // Some are straight on their line, some turn back on it, and some pass the origin itself.
    const along = 3 * (next() - 0.5);
    const [bendX, bendY] = next() < 0.3 ? [wayX * along, wayY * along] : [part(), part()];
    const motion = new RelativeMotion(x, y, wayX, wayY, bendX, bendY);
    const at = (s) => Math.hypot(x + s * wayX - s * (1 - s) * bendX, y + s * wayY - s * (1 - s) * bendY);
    const share = motion.nearestShare();
    const least = motion.distance(share);
    assert.ok(share >= 0 && share <= 1);
    assert.ok(Math.abs(at(share) - least) < 1e-9);
    const moved = (Math.hypot(wayX, wayY) + Math.hypot(bendX, bendY)) / SAMPLES / 2;
    let sampled = Infinity;
    for (let k = 0; k <= SAMPLES; k += 1) sampled = Math.min(sampled, at(k / SAMPLES));
    assert.ok(least <= sampled + 1e-9 && least >= sampled - moved - 1e-9, `${kind}: ${least}, ${sampled}`);
    assert.ok(motion.mayComeWithin(least + 1e-9));
    const first = motion.firstShareWithin(least + 1e-3);
    assert.ok(first !== null && at(first) <= least + 1e-3 + 1e-9);
    for (let s = 0; s < first; s += 0.01) assert.ok(at(s) >= least + 1e-3 - 1e-9, `${kind}`);
    assert.equal(motion.firstShareWithin(least - 1e-6), null);
  }
});
