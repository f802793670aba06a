// Taking things away: files and a command line.

/** Saves a text of JSON as a file. */
export function saveText(name, text) {
  saveBlob(name, new Blob([text], { type: "application/json" }));
}

export function saveBlob(name, blob) {
  const address = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** A file name, without its ending, for a request's name. */
export function fileStem(name) {
  return name.replace(/(\.plan)?\.(json|map|scen|ya?ml)$/i, "").replace(/[^\w.-]+/g, "-") || "request";
}

/** The command that plans the request from a POSIX shell; examples are fetched, other requests inlined. */
export function curlCommand({ example, text }, base) {
  const post = `curl -sS ${new URL("v1/plan", base)} -H 'Content-Type: application/json' --data-binary @-`;
  if (example !== null)
    return `curl -sS ${new URL(`v1/examples/${encodeURIComponent(example)}`, base)} | ${post}`;
  return `${post} <<'JSON'\n${text}\nJSON\n`;
}

/** Whether the text could be put on the clipboard. */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyThroughSelection(text); // no clipboard API without a secure context
  }
}

function copyThroughSelection(text) {
  const before = document.activeElement;
  const area = document.createElement("textarea");
  area.className = "visually-hidden";
  area.value = text;
  document.body.append(area);
  area.select();
  const copied = document.execCommand("copy");
  area.remove();
  before?.focus();
  return copied;
}
