// Which robots, by id, are pointed at. Pure.

export class Focus {
  hovered = null;
  selected = null;
  broughtOut = new Set(); // further ones, such as both robots of a collision

  /** The ids of all of them. */
  get all() {
    return new Set([this.hovered, this.selected, ...this.broughtOut].filter((id) => id !== null));
  }

  /** Selects the first of these ids and brings out the others. */
  bringOut(ids) {
    this.selected = ids[0] ?? null;
    this.broughtOut = new Set(ids.slice(1));
  }

  /** Forgets robots that are not there any longer; `known` has those that are. */
  keep(known) {
    if (!known.has(this.hovered)) this.hovered = null;
    if (!known.has(this.selected)) this.selected = null;
    this.broughtOut = new Set();
  }
}
