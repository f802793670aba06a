// The motion of one point relative to another, the origin, while the accelerations of both are constant. It is a
// parabola (x, y) + s (way) - s (1 - s) (bend), with s from 0 to 1.
//
// The squared distance is of degree four in s. Its extrema are found between the extrema of its derivative, which is
// monotone there. So distances are exact up to rounding, less than 1e-9 m for coordinates below 1e5 m. Pure. Metres.

const HALVINGS = 60; // of an interval within [0, 1], until rounding ends it

export class RelativeMotion {
  /** Where it begins, how far it gets, and its bend. */
  constructor(x, y, wayX, wayY, bendX, bendY) {
    this.x = x;
    this.y = y;
    this.slopeX = wayX - bendX;
    this.slopeY = wayY - bendY;
    this.bendX = bendX;
    this.bendY = bendY;
  }

  /** The distance at a share. */
  distance(share) {
    return Math.sqrt(this.#square(share));
  }

  /** Whether it may come within a distance of the origin: its chord, from which it is no farther than its sag, does. */
  mayComeWithin(distance) {
    const [wayX, wayY] = [this.slopeX + this.bendX, this.slopeY + this.bendY];
    const share = shareOfLine(this.x, this.y, wayX, wayY);
    const sag = Math.hypot(this.bendX, this.bendY) / 4;
    return Math.hypot(this.x + wayX * share, this.y + wayY * share) <= distance + sag;
  }

  /** The share at which it is nearest to the origin. */
  nearestShare() {
    if (this.#isStraight()) return shareOfLine(this.x, this.y, this.slopeX, this.slopeY);
    return this.#borders().reduce((nearest, share) =>
      this.#square(share) < this.#square(nearest) ? share : nearest,
    );
  }

  /** The first share at which it is within reach of the origin, or null. Only contact at the end is not within reach. */
  firstShareWithin(reach) {
    if (reach <= 0) return null;
    const beyond = (share) => this.#square(share) - reach * reach;
    if (beyond(0) < 0) return 0;
    const borders = this.#isStraight() ? [0, this.nearestShare(), 1] : this.#borders();
    const near = borders.findIndex((share) => beyond(share) < 0);
    if (near <= 0) return null;
    return changeBetween(borders[near - 1], borders[near], (share) => beyond(share) < 0);
  }

  #isStraight() {
    return this.bendX === 0 && this.bendY === 0;
  }

  #square(s) {
    const x = this.x + s * (this.slopeX + s * this.bendX);
    const y = this.y + s * (this.slopeY + s * this.bendY);
    return x * x + y * y;
  }

  /** Half of the derivative of the square. */
  #rise(s) {
    const x = this.x + s * (this.slopeX + s * this.bendX);
    const y = this.y + s * (this.slopeY + s * this.bendY);
    return x * (this.slopeX + 2 * s * this.bendX) + y * (this.slopeY + 2 * s * this.bendY);
  }

  /** Shares from 0 to 1 between which the square is monotone. */
  #borders() {
    const { x, y, slopeX, slopeY, bendX, bendY } = this;
    // Half of the second derivative of the square: constant + 2 linear s + quadratic s^2.
    const constant = slopeX * slopeX + slopeY * slopeY + 2 * (x * bendX + y * bendY);
    const linear = 3 * (slopeX * bendX + slopeY * bendY);
    const quadratic = 6 * (bendX * bendX + bendY * bendY);
    const turns = [0, ...rootsWithin(constant, linear, quadratic), 1];
    const borders = [0];
    for (let k = 1; k < turns.length; k += 1) {
      const falls = this.#rise(turns[k - 1]) < 0;
      if (this.#rise(turns[k]) < 0 === falls) continue;
      borders.push(changeBetween(turns[k - 1], turns[k], (share) => this.#rise(share) < 0 !== falls));
    }
    borders.push(1);
    return borders;
  }
}

/** The share at which a point that moves evenly from (x, y) by a way is nearest to the origin. */
function shareOfLine(x, y, wayX, wayY) {
  const squared = wayX * wayX + wayY * wayY;
  return squared > 0 ? Math.min(1, Math.max(0, -(x * wayX + y * wayY) / squared)) : 0;
}

/** The roots of constant + 2 linear s + quadratic s^2 within (0, 1), ascending, without cancellation. */
function rootsWithin(constant, linear, quadratic) {
  const square = linear * linear - quadratic * constant;
  if (!(square > 0)) return [];
  const sum = -(linear + (linear < 0 ? -1 : 1) * Math.sqrt(square));
  return [sum / quadratic, constant / sum].filter((root) => root > 0 && root < 1).sort((a, b) => a - b);
}

/** The share between two, at the later one of which `isPast` holds, from which on it does. */
function changeBetween(before, past, isPast) {
  for (let halving = 0; halving < HALVINGS; halving += 1) {
    const middle = (before + past) / 2;
    if (middle === before || middle === past) break;
    if (isPast(middle)) past = middle;
    else before = middle;
  }
  return past;
}
