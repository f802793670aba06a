// The inner loops of planning, each alone: Google Benchmark's flags, such as --benchmark_filter=Departure.
//
// The inputs are queries among the robots of a plan for the paper's halls.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/geometry/disk_motion.h"
#include "core/map/line_of_sight.h"
#include "core/model/problem.h"
#include "core/plan/planner.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/random.h"
#include "tests/bench/workload.h"

namespace fleetplan::bench {
namespace {

using core::Position;
using core::Segment;
using core::TimedSegment;

/// Inputs of a kernel are drawn beforehand, enough of them to defeat branch prediction.
constexpr std::size_t kInputs = 4096;

/// The robots' numbers in the crowd that moves.
constexpr std::size_t kCrowd = 150;

Position random_center(const core::OccupancyGrid& grid, core::Random& random) {
  const auto column = random.below(static_cast<std::size_t>(grid.columns()));
  const auto row = random.below(static_cast<std::size_t>(grid.rows()));
  return grid.center({static_cast<int>(column), static_cast<int>(row)});
}

/// The centre of a cell at most `cells` columns and rows away, and not the same.
Position random_center_near(const core::OccupancyGrid& grid, const Position& position, int cells,
                            core::Random& random) {
  const core::Cell at = grid.cell_at(position);
  const auto around = [&](int center, int count) {
    const int low = std::max(0, center - cells);
    const int places = std::min(count - 1, center + cells) - low + 1;
    return low + static_cast<int>(random.below(static_cast<std::size_t>(places)));
  };
  core::Cell other = at;
  while (other == at) other = {around(at.column, grid.columns()), around(at.row, grid.rows())};
  return grid.center(other);
}

std::vector<Segment> random_segments(const core::OccupancyGrid& grid, int cells) {
  core::Random random(1);
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const Position from = random_center(grid, random);
    segments.push_back({from, random_center_near(grid, from, cells, random)});
  }
  return segments;
}

/// Whether a disk may sweep a segment between cells up to this many apart, among the paper's rectangles.
void BM_LineOfSight(benchmark::State& state) {
  const core::OccupancyGrid grid = generate(hall_with_rectangles(), 1).grid;
  const core::LineOfSight sight(grid, core::StopCondition::never());
  const auto segments = random_segments(grid, static_cast<int>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) {
    const Segment& segment = segments[next++ % kInputs];
    benchmark::DoNotOptimize(sight.may_sweep(segment.from, segment.to, 0.5));
  }
}
BENCHMARK(BM_LineOfSight)->ArgName("cells")->Arg(1)->Arg(8)->Arg(63);

/// Moves to neighbouring cells, and timed segments near them.
struct Encounters {
  explicit Encounters(double ramp) {
    const core::OccupancyGrid grid(64, 64, 1.0);
    mine = random_segments(grid, 1);
    core::Random random(2);
    for (const Segment& segment : mine) {
      const Position from = random_center_near(grid, segment.from, 3, random);
      const Segment path{from, random_center_near(grid, from, 3, random)};
      const double begin = 10.0 * random.unit();
      others.emplace_back(TimedSegment{path, begin, begin + path.length() / 1.5, ramp});
    }
  }
  std::vector<Segment> mine;
  std::vector<core::MovingDisk> others;
};

/// The window of departures that one timed segment forbids to a move to a neighbouring cell. Both are at
/// constant speed, or both from rest at constant acceleration.
void BM_ForbiddenDepartures(benchmark::State& state) {
  const auto ramp = static_cast<double>(state.range(0));
  const Encounters encounters(ramp);
  std::size_t next = 0;
  for (auto _ : state) {
    const std::size_t i = next++ % kInputs;
    const Segment& mine = encounters.mine[i];
    const Position move = mine.to - mine.from;
    benchmark::DoNotOptimize(core::forbidden_departures(mine.from, move.normalized(), move.norm(),
                                                        encounters.others[i], 0.8, ramp));
  }
}
BENCHMARK(BM_ForbiddenDepartures)->ArgName("ramp")->Arg(0)->Arg(1);

/// Whether two disks collide at one departure.
void BM_Collide(benchmark::State& state) {
  const auto ramp = static_cast<double>(state.range(0));
  const Encounters encounters(ramp);
  std::vector<core::MovingDisk> movers;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const Segment& mine = encounters.mine[i];
    const double begin = encounters.others[i].t_start;
    movers.emplace_back(TimedSegment{mine, begin, begin + mine.length(), ramp});
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const std::size_t i = next++ % kInputs;
    benchmark::DoNotOptimize(core::collide(movers[i], encounters.others[i], 0.8));
  }
}
BENCHMARK(BM_Collide)->ArgName("ramp")->Arg(0)->Arg(1);

/// The reservations of a planned hall, without the last robots, which ask.
class Crowd {
 public:
  explicit Crowd(const Recipe& recipe) : workload_(generate(recipe, 1)), table_(table_of(workload_)) {
    std::vector<core::Robot> robots(workload_.robots.begin(), workload_.robots.begin() + kCrowd);
    const auto made = core::Problem::create(workload_.grid, robots, core::StopCondition::never());
    const core::Plan plan = core::plan(std::get<core::Problem>(made), {}, core::StopCondition::never());
    for (const core::RobotPlan& robot : plan.plans)
      table_.reserve(robot.robot, reservations(workload_.robots[robot.robot], robot));
  }

  const core::OccupancyGrid& grid() const { return workload_.grid; }
  const core::ReservationTable& table() const { return table_; }
  const core::Robot& robot(std::size_t index) const { return workload_.robots[index]; }
  core::Footprint footprint(std::size_t index) const { return {index, robot(index).radius}; }

 private:
  static core::ReservationTable table_of(const Workload& workload) {
    std::vector<core::LargestDisk> disks;
    for (const core::Robot& robot : workload.robots) disks.push_back({robot.radius, robot.radius});
    return {workload.grid.width(), workload.grid.height(), workload.grid.resolution(), std::move(disks)};
  }

  /// From t = 0 to for ever, rotations and waits as standing.
  static std::vector<core::SizedSegment> reservations(const core::Robot& robot, const core::RobotPlan& plan) {
    std::vector<core::SizedSegment> segments;
    Position at = robot.start.position;
    double now = 0.0;
    for (const core::Action& action : plan.actions) {
      if (action.t_end > now)
        segments.push_back({{{action.from.position, action.to.position}, now, action.t_end}, robot.radius});
      at = action.to.position;
      now = action.t_end;
    }
    segments.push_back({{{at, at}, now, core::kForever}, robot.radius});
    return segments;
  }

  Workload workload_;
  core::ReservationTable table_;
};

/// A question that a robot which is not in the crowd asks of it.
struct Question {
  std::size_t robot;
  Segment path;
  double t_min;
};

std::vector<Question> questions(const Crowd& crowd, int cells) {
  constexpr double kUntil = 60.0;  // seconds; by then half of the crowd has arrived
  core::Random random(3);
  std::vector<Question> asked;
  for (const Segment& segment : random_segments(crowd.grid(), cells))
    asked.push_back({kCrowd + random.below(3), segment, kUntil * random.unit()});
  return asked;
}

/// When a robot may stand somewhere.
void BM_SafeIntervals(benchmark::State& state) {
  const Crowd crowd(hall_with_rectangles());
  const auto asked = questions(crowd, 1);
  std::size_t next = 0;
  for (auto _ : state) {
    const Question& question = asked[next++ % kInputs];
    benchmark::DoNotOptimize(
        crowd.table().safe_intervals(crowd.footprint(question.robot), question.path.from));
  }
}
BENCHMARK(BM_SafeIntervals);

/// When a robot may make a move between cells up to so many apart at the earliest.
void BM_EarliestDeparture(benchmark::State& state) {
  const Crowd crowd(hall_with_rectangles());
  const auto asked = questions(crowd, static_cast<int>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) {
    const Question& question = asked[next++ % kInputs];
    const double duration = question.path.length() / crowd.robot(question.robot).linear_speed;
    benchmark::DoNotOptimize(crowd.table().earliest_departure(crowd.footprint(question.robot), question.path,
                                                              duration, question.t_min, core::kForever));
  }
}
BENCHMARK(BM_EarliestDeparture)->ArgName("cells")->Arg(1)->Arg(8)->Arg(32);

}  // namespace
}  // namespace fleetplan::bench
