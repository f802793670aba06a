// The committed actions of a robot, in its form: seen, shortened, extended, edited as JSON and removed.

import assert from "node:assert/strict";
import { test } from "node:test";

import { choose, pressPlan } from "../support/browser.js";
import { hook, pagesFor, REFUSED } from "../support/on_page.js";

const onPage = pagesFor();
const first = (page) => page.locator("#committed-number input");
const committedOf = async (page, index) => (await hook(page, "request")).robots[index].committed;

/** Opens the example and the form of its first robot with several committed actions: its index and these. */
async function openForm(page) {
  const { robots } = await choose(page, "rush-hour");
  const index = robots.findIndex(({ committed }) => committed?.length > 1);
  await page.click("#tab-edit");
  await page.selectOption("#edited-robot", String(index));
  await page.click("#committed summary");
  return { index, committed: robots[index].committed };
}

/** Types how many actions are committed. */
async function commitFirst(page, number) {
  await first(page).focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.type(String(number));
  await page.keyboard.press("Tab");
}

test("a commitment is shown, shortened and removed by keys alone", async () => {
  await onPage(async (page) => {
    const { index, committed } = await openForm(page);
    assert.equal(await page.locator("#committed-list li").count(), committed.length);
    assert.match(await page.locator("#committed-list li").first().innerText(), /^0\.00 to .* s: /);
    await commitFirst(page, 1);
    assert.deepEqual(await committedOf(page, index), committed.slice(0, 1));
    assert.deepEqual(JSON.parse(await page.inputValue("#committed-json")), committed.slice(0, 1));
    await commitFirst(page, committed.length + 1);
    assert.match(await page.innerText("#committed-number"), /from 0 to 1\./);
    assert.deepEqual(
      await committedOf(page, index),
      committed.slice(0, 1),
      "there is no plan to commit more of",
    );
    await page.focus("#remove-committed");
    await page.keyboard.press("Enter");
    assert.equal(await committedOf(page, index), undefined);
    assert.equal(await page.inputValue("#committed-json"), "");
    await page.click("#undo");
    assert.deepEqual(await committedOf(page, index), committed.slice(0, 1));
  });
});

test("the first actions of a plan are committed, and the next plan begins with them", async () => {
  await onPage(async (page) => {
    const request = await choose(page, "crossing");
    const answer = await pressPlan(page);
    const { robot, actions } = answer.plans.find((plan) => plan.actions.length > 2);
    const index = request.robots.findIndex(({ id }) => id === robot);
    await page.click("#tab-edit");
    await page.selectOption("#edited-robot", String(index));
    await page.click("#committed summary");
    await commitFirst(page, 2);
    assert.deepEqual(await committedOf(page, index), actions.slice(0, 2));
    const { plans } = await pressPlan(page);
    const again = plans.find((plan) => plan.robot === robot).actions;
    assert.deepEqual(
      again.slice(0, 2).map(({ t_end }) => t_end),
      actions.slice(0, 2).map(({ t_end }) => t_end),
    );
  });
});

test("a commitment is edited as JSON; what is none is told at once, what is faulty at its place", async () => {
  await onPage(
    async (page) => {
      const { index, committed } = await openForm(page);
      const type = async (text) => {
        await page.fill("#committed-json", text);
        await page.keyboard.press("Tab");
      };
      await type("[{");
      assert.match(await page.innerText("#committed-fault"), /^Enter the actions as JSON: /);
      assert.deepEqual(await committedOf(page, index), committed);
      const early = committed.map((action, at) => (at === 0 ? { ...action, t_start: 1 } : action));
      await type(JSON.stringify(early));
      assert.equal(await page.innerText("#committed-fault"), "");
      assert.deepEqual(await committedOf(page, index), early);
      await page.waitForSelector("#committed .field-error");
      await type(JSON.stringify(committed));
      await page.waitForSelector("#committed .field-error", { state: "detached" });
      assert.deepEqual(await committedOf(page, index), committed);
    },
    { allowed: REFUSED },
  );
});
