// Times as people type them. Pure. Seconds.

const NUMBER = String.raw`\d+(?:[.,]\d*)?|[.,]\d+`;
const WHOLE = new RegExp(`^(?:(?:(\\d+):)?(\\d+):)?(${NUMBER})\\s*(s|%)?$`);

/** The time in a text, seconds: "12.5", "12,5 s", "1:05", "1:00:05.5", or "40 %" of a duration; null otherwise. */
export function readTime(text, duration) {
  const found = WHOLE.exec(text.trim());
  if (found === null) return null;
  const [, hours = "0", minutes = "0", rest, unit] = found;
  const value = Number(rest.replace(",", "."));
  if (unit === "%") return found[2] === undefined ? (value / 100) * duration : null;
  return Number(hours) * 3600 + Number(minutes) * 60 + value;
}
