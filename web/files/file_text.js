// Reading texts line by line, and why a file cannot be used.

/** The message says what is wrong, where in the file, and what to do; whoever reads the file adds its name. */
export class FileError extends Error {
  constructor(message) {
    super(message);
    this.name = "FileError";
  }
}

/** What a faulty piece of a file looked like, shortened for a message. */
export function quoted(value) {
  const text = JSON.stringify(value);
  return text.length > 30 ? `${text.slice(0, 28)}…` : text;
}

/** The lines of a text, whatever system ended them. */
export const linesOf = (text) => text.split(/\r\n|\r|\n/);
