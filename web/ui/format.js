// Numbers for people.

/** A number with commas between thousands. Browsers take a tenth of a second for the first toLocaleString. */
export const grouped = (number) => String(number).replace(/\B(?=(\d{3})+(\.|$))/g, ",");

export const seconds = (value) => `${grouped(value.toFixed(value < 1000 ? 2 : 1))} s`;

export function milliseconds(value) {
  if (value >= 1000) return `${(value / 1000).toFixed(2)} s`;
  return `${value.toFixed(value < 10 ? 2 : 0)} ms`;
}

export function metres(value) {
  if (Math.abs(value) < 5e-6) return "0 mm";
  if (Math.abs(value) < 1) return `${(value * 1000).toFixed(Math.abs(value) < 0.01 ? 2 : 0)} mm`;
  return `${value.toFixed(2)} m`;
}

/** Bytes, in words. */
export const megabytes = (bytes) => `${grouped(Math.round(bytes / 1e5) / 10)} MB`;

export const count = (value, one, many = `${one}s`) => `${grouped(value)} ${value === 1 ? one : many}`;

export const degrees = (radians) => `${Math.round((radians * 180) / Math.PI)}°`;
