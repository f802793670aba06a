// The subset of YAML that a map.yaml needs: one mapping of keys to scalars and lists of scalars.

import { FileError, quoted } from "../model/problem.js";
import { linesOf } from "./text.js";

const QUOTED = String.raw`"(?:[^"\\]|\\.)*"|'(?:[^']|'')*'`;
const KEY = new RegExp(String.raw`^(${QUOTED}|[^\s"'#&*!|>%@\x60[\]{},?:-][^:#]*?)\s*:(?=\s|$)`);
const NUMBER = /^[-+]?(\d[\d_]*(\.\d*)?|\.\d+)([eE][-+]?\d+)?$/;

/** The text as an object of strings, numbers, booleans, nulls and lists of such values. Throws FileError. */
export function readYaml(text) {
  const lines = logicalLines(text);
  const found = {};
  let key = null; // whose value is a list on the following lines
  for (const { number, content } of lines) {
    const item = /^\s*-(?:\s+(.*))?$/.exec(content);
    if (item && key !== null) {
      found[key] ??= [];
      found[key].push(readScalar(item[1] ?? "", number));
      continue;
    }
    const named = KEY.exec(content);
    if (!named) throw new FileError(`Line ${number} is ${quoted(content)}, where "key: value" is expected.`);
    const name = /^["']/.test(named[1]) ? readScalar(named[1], number) : named[1];
    if (Object.hasOwn(found, name)) throw new FileError(`Line ${number} has ${quoted(name)} a second time.`);
    const value = content.slice(named[0].length).trim();
    found[name] = value === "" ? null : readValue(value, number);
    key = value === "" ? name : null;
  }
  return found;
}

/** The lines without comments: [{number, content}]; a list in brackets that spans lines is joined. */
function logicalLines(text) {
  const lines = [];
  let open = null;
  for (const [index, raw] of linesOf(text).entries()) {
    const content = withoutComment(raw).trimEnd();
    if (/^(---|\.\.\.|%.*)$/.test(content) || content.trim() === "") continue;
    if (open) {
      open.content += ` ${content.trim()}`;
    } else {
      open = { number: index + 1, content };
      lines.push(open);
    }
    if (!/:\s*\[[^\]]*$/.test(open.content)) open = null;
  }
  if (open) throw new FileError(`The list that begins on line ${open.number} is not closed with "]".`);
  return lines;
}

function withoutComment(line) {
  const pieces = new RegExp(String.raw`(?<=^|[\s,[])(?:${QUOTED})|(?:^|\s)#.*`, "g");
  return line.replace(pieces, (piece) => (/^["']/.test(piece) ? piece : ""));
}

function readValue(text, number) {
  if (!text.startsWith("[")) return readScalar(text, number);
  const inner = /^\[(.*)\]$/.exec(text)?.[1];
  if (inner === undefined || /[[\]{}]/.test(inner.replace(new RegExp(QUOTED, "g"), "")))
    throw new FileError(`Line ${number}: the list ${quoted(text)} is not understood; write [a, b, c].`);
  const items = inner.match(new RegExp(String.raw`\s*(?:${QUOTED})|[^,]+|,`, "g")) ?? [];
  return items
    .map((item) => item.trim())
    .filter((item) => item !== "," && item !== "")
    .map((item) => readScalar(item, number));
}

function readScalar(text, number) {
  if (/^"(?:[^"\\]|\\.)*"$/.test(text)) return unescaped(text, number);
  if (/^'(?:[^']|'')*'$/.test(text)) return text.slice(1, -1).replaceAll("''", "'");
  if (/^["'&*!|>%@`{}[\]]|^[-?:](\s|$)|:\s|\s*:$/.test(text))
    throw new FileError(
      `Line ${number}: ${quoted(text)} is not understood here; write a plain value or a list.`,
    );
  if (NUMBER.test(text)) return Number(text.replaceAll("_", ""));
  if (/^[-+]?\.inf$/i.test(text)) return text.startsWith("-") ? -Infinity : Infinity;
  if (/^\.nan$/i.test(text)) return NaN;
  if (/^(true|yes|on)$/i.test(text)) return true;
  if (/^(false|no|off)$/i.test(text)) return false;
  return /^(null|~)?$/i.test(text) ? null : text;
}

function unescaped(text, number) {
  try {
    return JSON.parse(text); // JSON has the escapes of YAML that matter in a file's name
  } catch {
    throw new FileError(`Line ${number}: the quoted text ${quoted(text)} is not understood.`);
  }
}
