// Reading files of the browser (File), with their names in what goes wrong.

import { HEAD_BYTES } from "./file_kinds.js";
import { FileError } from "./file_text.js";

/** The first bytes of a file, enough to tell its kind. */
export const headOf = (file) =>
  reading(file, async () => bytesIn(await file.slice(0, HEAD_BYTES).arrayBuffer()));

export const textOf = (file) => reading(file, () => file.text());

export const bytesOf = (file) => reading(file, async () => bytesIn(await file.arrayBuffer()));

/** What `read` makes of a file's content, or resolves to; the file is named in the FileError it may end with. */
export function about({ name }, read) {
  const named = (error) => {
    throw error instanceof FileError ? new FileError(`${name}: ${error.message}`) : error;
  };
  try {
    const made = read();
    return made instanceof Promise ? made.catch(named) : made;
  } catch (error) {
    return named(error);
  }
}

function bytesIn(buffer) {
  return new Uint8Array(buffer);
}

async function reading({ name }, read) {
  try {
    return await read();
  } catch {
    throw new FileError(`${name} cannot be read. Is it a folder, or was it moved or changed meanwhile?`);
  }
}
