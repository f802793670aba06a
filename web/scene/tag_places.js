// Places for the names beside disks, so that they do not cover each other. Pure. CSS pixels.

const HEIGHT = 20; // of a name with some room

export class TagPlaces {
  #taken = []; // {x, y, width}

  /**
   * The middle of a name of some width, `beyond` pixels above the centre of its disk. If another name is there, below
   * or beside the disk.
   */
  place({ x, y }, beyond, width) {
    const aside = beyond + width / 2;
    const places = [
      { x, y: y - beyond },
      { x, y: y + beyond },
      { x: x - aside, y },
      { x: x + aside, y },
    ];
    const found = places.find((place) => this.#isFree(place, width)) ?? places[0];
    this.#taken.push({ ...found, width });
    return found;
  }

  #isFree({ x, y }, width) {
    return this.#taken.every(
      (other) => Math.abs(other.y - y) >= HEIGHT || Math.abs(other.x - x) >= (other.width + width) / 2,
    );
  }
}
