import assert from "node:assert/strict";
import { test } from "node:test";

import { EarlierPlans } from "../../../web/model/earlier_plans.js";
import { differences, previousPlans, summed } from "../../../web/model/plan_difference.js";
import { Session } from "../../../web/model/session.js";

const at = (x, y = 0) => ({ x, y, theta: 0 });
const drive = (t_start, t_end, from, to) => ({ type: "translate", t_start, t_end, from, to });
const plan = (robot, ...actions) => ({ robot, cost: actions.at(-1)?.t_end ?? 0, actions });

const BEFORE = [
  plan("a", drive(0, 2, at(0), at(2))),
  plan("b", drive(0, 2, at(0), at(2))),
  plan("c", drive(0, 2, at(0), at(2))),
  plan("gone", drive(0, 1, at(0), at(1))),
];
const NOW = [
  plan("a", drive(0, 2, at(0), at(2 + 1e-9))),
  plan("b", drive(0, 2.5, at(0), at(2))),
  plan("c", drive(0, 1, at(0), at(1, 1)), drive(1, 3, at(1, 1), at(2))),
  plan("new", drive(0, 4, at(0), at(4))),
];

test("each robot has the difference of its costs and what changed, the largest first", () => {
  const rows = differences(NOW, BEFORE);
  assert.deepEqual(
    rows.map(({ id, change, difference }) => [id, change, difference]),
    [
      ["new", "only here", null],
      ["gone", "only there", null],
      ["c", "path", 1],
      ["b", "times", 0.5],
      ["a", "same", 0],
    ],
  );
  assert.deepEqual(summed(rows), { robots: 5, changed: 4, flowtime: 1.5, makespan: 1 });
});

test("a plan does not differ from itself", () => {
  assert.deepEqual(summed(differences(NOW, NOW)), { robots: 4, changed: 0, flowtime: 0, makespan: 0 });
});

test("the previous plans of a request are plans", () => {
  assert.equal(previousPlans({ robots: [{ id: "a" }] }), null);
  const [{ actions }] = NOW;
  const plans = previousPlans({ robots: [{ id: "a", previous: actions }, { id: "b", previous: [] }, null] });
  assert.deepEqual(plans, [
    { robot: "a", cost: 2, actions },
    { robot: "b", cost: 0, actions: [] },
  ]);
});

test("the plans shown before are kept for the robots and their tasks, the latest first, each once", () => {
  const session = new Session({}, () => {});
  const earlier = new EarlierPlans(session);
  const robot = { id: "a", start: { x: 0.5, y: 0.5 } };
  const request = { map: { rows: ["."] }, robots: [robot] };
  session.open({ name: "one", example: null, text: "", request });
  const answers = Array.from({ length: 8 }, (_, n) => ({ plans: [plan(`${n}`)], unplanned: [] }));
  for (const answer of answers) session.adopt(answer);
  assert.deepEqual(earlier.all, answers.slice(2, 7).reverse());
  session.adopt(answers[5]);
  assert.equal(earlier.all[0], answers[7]);
  const reopened = { map: { rows: ["."] }, robots: [{ ...robot, previous: [] }], options: { seed: 2 } };
  session.open({ name: "two", example: null, text: "", request: reopened });
  assert.equal(earlier.all[0], answers[5], "another seed and previous plans are of the same task");
  const elsewhere = { ...reopened, robots: [{ ...robot, goal: { x: 0.5, y: 0.5 } }] };
  session.open({ name: "three", example: null, text: "", request: elsewhere });
  assert.deepEqual(earlier.all, []);
});

test("who listens after a comparison was asked for is told at once", () => {
  const earlier = new EarlierPlans(new Session({}, () => {}));
  let told = 0;
  earlier.compare();
  earlier.onAsked(() => (told += 1));
  assert.equal(told, 1);
  earlier.compare();
  assert.equal(told, 2);
});
