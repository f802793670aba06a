// Saving files.

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
