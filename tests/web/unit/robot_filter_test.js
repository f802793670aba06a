import assert from "node:assert/strict";
import { test } from "node:test";

import { RobotFilter } from "../../../web/model/robot_filter.js";
import { Session } from "../../../web/model/session.js";

const at = (x) => ({ x, y: 0.5, theta: 0 });
const robot = (id, x) => ({ id, radius: 0.2, start: at(x), goal: at(x + 1) });
const REQUEST = {
  map: { rows: ["........"] },
  robots: [robot("Tote-1", 0.5), robot("tote-2", 2.5), robot("cart", 4.5), robot("late", 6.5)],
};
const drive = (x, begin) => [
  { type: "wait", t_start: 0, t_end: begin, from: at(x), to: at(x) },
  { type: "translate", t_start: begin, t_end: begin + 1, from: at(x), to: at(x + 1) },
];
const plan = (id, x, begin) => ({
  robot: id,
  cost: begin + 1,
  lower_bound: 1,
  actions: drive(x, begin),
});
const ANSWER = {
  plans: [plan("Tote-1", 0.5, 2), plan("tote-2", 2.5, 5), plan("cart", 4.5, 9)],
  unplanned: [{ robot: "late", reason: "budget_exhausted" }],
};

/** A session with the answer, its filter, and how often that changed. */
function begin() {
  const session = new Session({}, () => {});
  const filter = new RobotFilter(session);
  const heard = [];
  filter.onChange(() => heard.push(filter.robots.map(({ id }) => id)));
  session.open({ name: "one", example: null, text: "", request: REQUEST }, ANSWER);
  return { session, filter, heard };
}

const ids = (filter) => filter.robots.map(({ id }) => id);

test("all robots are listed at first", () => {
  const { filter } = begin();
  assert.deepEqual(ids(filter), ["Tote-1", "tote-2", "cart", "late"]);
  assert.equal(filter.isOpen, true);
});

test("a text filters by any part of the id, in any case", () => {
  const { filter } = begin();
  filter.set({ text: " TOTE" });
  assert.deepEqual(ids(filter), ["Tote-1", "tote-2"]);
  assert.equal(filter.isOpen, false);
  filter.set({ text: "" });
  assert.equal(filter.isOpen, true);
});

test("a state filters by what robots do at the moment", () => {
  const { session, filter, heard } = begin();
  filter.set({ doing: "waiting" });
  assert.deepEqual(ids(filter), ["Tote-1", "tote-2", "cart"]);
  const before = heard.length;
  session.seek(2.5);
  filter.refresh();
  assert.deepEqual(heard.slice(before), [["tote-2", "cart"]]);
  session.seek(2.6);
  filter.refresh();
  assert.equal(heard.length, before + 1, "no change, no signal");
  filter.set({ doing: "unplanned" });
  assert.deepEqual(ids(filter), ["late"]);
});

test("delayed robots cost more than so many seconds above their lower bounds", () => {
  const { filter } = begin();
  filter.set({ doing: "delayed" });
  assert.deepEqual(ids(filter), ["Tote-1", "tote-2", "cart"]);
  filter.set({ delay: 5 });
  assert.deepEqual(ids(filter), ["cart"]);
});

test("steps go through the robots that pass, around both ends", () => {
  const { filter } = begin();
  filter.set({ text: "tote" });
  assert.equal(filter.next(null), "Tote-1");
  assert.equal(filter.next("Tote-1"), "tote-2");
  assert.equal(filter.next("tote-2"), "Tote-1");
  assert.equal(filter.next("Tote-1", -1), "tote-2");
  assert.equal(filter.next("cart", -1), "tote-2", "from one that does not pass");
  filter.set({ text: "nobody" });
  assert.equal(filter.next(null), null);
});
