import assert from "node:assert/strict";
import { test } from "node:test";

import { History } from "../../../web/model/history.js";

test("a new history has nothing to undo or redo", () => {
  const history = new History("a");
  assert.deepEqual([history.present, history.canUndo, history.canRedo], ["a", false, false]);
  history.undo();
  history.redo();
  assert.equal(history.present, "a");
});

test("undo and redo go through all values, back and forth", () => {
  const history = new History("a");
  history.push("b");
  history.push("c");
  history.undo();
  history.undo();
  assert.deepEqual([history.present, history.canUndo, history.canRedo], ["a", false, true]);
  history.redo();
  history.redo();
  assert.deepEqual([history.present, history.canUndo, history.canRedo], ["c", true, false]);
});

test("a new value after an undo leaves nothing to redo", () => {
  const history = new History("a");
  history.push("b");
  history.undo();
  history.push("c");
  assert.equal(history.canRedo, false);
  history.undo();
  assert.equal(history.present, "a");
});

test("values of one gesture are one step, until it ends or something else comes between", () => {
  const history = new History("a");
  history.push("b", "drag");
  history.push("c", "drag");
  history.undo();
  assert.equal(history.present, "a");
  history.push("d", "drag");
  history.endGesture();
  history.push("e", "drag");
  history.push("f", "type");
  history.push("g", "drag");
  const seen = [];
  while (history.canUndo) {
    history.undo();
    seen.push(history.present);
  }
  assert.deepEqual(seen, ["f", "e", "d", "a"]);
});

test("a value that replaces another leaves no step to it and nothing to redo", () => {
  const history = new History("a");
  history.push("b", "drag");
  history.push("c");
  history.undo();
  history.replace("d");
  assert.deepEqual([history.present, history.canRedo], ["d", false]);
  history.push("e", "drag");
  history.undo();
  assert.equal(history.present, "d");
  history.undo();
  assert.equal(history.present, "a");
});

test("an undo ends a gesture", () => {
  const history = new History("a");
  history.push("b", "drag");
  history.push("c", "type");
  history.undo();
  history.push("d", "drag");
  history.undo();
  assert.equal(history.present, "b");
});
