import assert from "node:assert/strict";
import { test } from "node:test";

import { deleteRobot, setRobot } from "../../../web/model/edit_request.js";
import { RobotChoice } from "../../../web/model/selection.js";
import { Session } from "../../../web/model/session.js";

const at = (x) => ({ radius: 0.3, start: { x, y: 0.5 } });
const REQUEST = {
  map: { rows: ["....."] },
  robots: [
    { id: "a", ...at(0.5) },
    { id: "b", ...at(1.5) },
    { id: "c", start: { x: 2.5 } },
  ],
};

/** A session with the request and the choice among its robots. */
function begin() {
  const session = new Session({}, () => {});
  const choice = new RobotChoice(session);
  session.open({ name: "one", example: null, text: JSON.stringify(REQUEST), request: REQUEST });
  return { session, choice };
}

test("the robot selected in the scene is edited, and none once it is deselected", () => {
  const { session, choice } = begin();
  assert.equal(choice.index, null);
  session.select("b");
  assert.deepEqual([choice.index, choice.robot.id], [1, "b"]);
  session.select(null);
  assert.equal(choice.index, null);
});

test("a robot that cannot be drawn can be edited", () => {
  const { session, choice } = begin();
  session.select("a");
  choice.choose(2);
  assert.deepEqual([choice.index, choice.robot, session.selected], [2, null, null]);
  session.hover("b");
  assert.equal(choice.index, 2);
});

test("the edited robot stays the same while it is renamed, broken and repaired", () => {
  const { session, choice } = begin();
  choice.choose(1);
  session.edit(setRobot(session.request, 1, "id", "carrier"));
  assert.deepEqual([choice.index, session.selected], [1, "carrier"]);
  session.edit(setRobot(session.request, 1, "radius", -1));
  assert.deepEqual([choice.index, session.selected], [1, null]);
  session.edit(setRobot(session.request, 1, "radius", 0.2));
  assert.deepEqual([choice.index, session.selected], [1, "carrier"]);
});

test("the edited robot is followed to another index, until it is deleted", () => {
  const { session, choice } = begin();
  choice.choose(1);
  session.edit(deleteRobot(session.request, 0));
  assert.deepEqual([choice.index, session.selected], [0, "b"]);
  choice.choose(1);
  session.edit(deleteRobot(session.request, 1));
  assert.equal(choice.index, null);
});

test("of two robots with the same id, the right one is edited", () => {
  const { session, choice } = begin();
  session.edit(setRobot(session.request, 1, "id", "a"));
  choice.choose(0);
  assert.equal(choice.index, 0);
  choice.choose(1);
  assert.equal(choice.index, 1);
});
