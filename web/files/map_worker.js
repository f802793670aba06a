// A worker that does the work of map_work.js, to keep the page responsive. It answers each message {id, name, args} by
// {id, result}, or by {id, fault, isOfFile} if the work failed.

import { FileError } from "../model/problem.js";
import { MAP_WORK } from "./map_work.js";

addEventListener("message", async ({ data: { id, name, args } }) => {
  try {
    postMessage({ id, result: await MAP_WORK[name](...args) });
  } catch (error) {
    postMessage({ id, fault: /** @type {Error} */ (error).message, isOfFile: error instanceof FileError });
  }
});
