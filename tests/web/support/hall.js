// An empty hall full of robots, each of which moves one metre up.

/** A request with so many robots, at most 1000. */
export function hallWith(robots) {
  return {
    map: { rows: Array(42).fill(".".repeat(52)) },
    robot_defaults: { radius: 0.3, linear_speed: 1, angular_speed: 1 },
    robots: Array.from({ length: robots }, (_, at) => {
      const start = { x: 1.5 + (at % 50), y: 1.5 + 2 * Math.floor(at / 50) };
      return { id: `robot-${at}`, start, goal: { ...start, y: start.y + 1 } };
    }),
  };
}
