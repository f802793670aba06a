// Chooses robots by a box. With Shift, the pointer drags a rectangle over them. With Ctrl as well, they are added to
// the robots chosen already.

export class BoxSelection {
  #session;
  #stage;
  /** @type {any} */
  #corner = null; // of the box, and the one opposite; null without one
  /** @type {any} */
  #end = null;

  constructor(session, stage) {
    this.#session = session;
    this.#stage = stage;
  }

  press(world, event) {
    if (!event.shiftKey) return false;
    this.#corner = this.#end = world;
    return true;
  }

  drag(world) {
    this.#end = world;
    this.#stage.redraw();
  }

  release(world, event) {
    this.#end = world;
    const found = this.#inside();
    const added = event.ctrlKey || event.metaKey ? this.#session.chosen : [];
    this.abort();
    this.#session.highlight([...new Set([...added, ...found])]);
    this.#session.announce(`${this.#session.chosen.length} robots selected.`);
  }

  abort() {
    this.#corner = this.#end = null;
    this.#stage.redraw();
  }

  paint(context, { screen, theme }) {
    if (this.#corner === null) return;
    const [a, b] = [screen(this.#corner), screen(this.#end)];
    context.save();
    context.strokeStyle = context.fillStyle = theme.accent;
    context.lineWidth = 1.5;
    context.setLineDash([5, 4]);
    context.strokeRect(a.x, a.y, b.x - a.x, b.y - a.y);
    context.globalAlpha = 0.1;
    context.fillRect(a.x, a.y, b.x - a.x, b.y - a.y);
    context.restore();
  }

  /** The ids of the robots whose centres are in the box now. */
  #inside() {
    const [a, b] = [this.#corner, this.#end];
    const within = (value, one, other) => value >= Math.min(one, other) && value <= Math.max(one, other);
    return this.#session.scene.robots
      .filter(({ id }) => {
        const { x, y } = this.#session.poseOf(id);
        return within(x, a.x, b.x) && within(y, a.y, b.y);
      })
      .map(({ id }) => id);
  }
}
