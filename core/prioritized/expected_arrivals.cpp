#include "core/prioritized/expected_arrivals.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "core/geometry/bucket_grid.h"
#include "core/geometry/disk_motion.h"
#include "core/instance/instance.h"
#include "core/prioritized/search_memory.h"
#include "core/prioritized/static_ways.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {
namespace {

/// How many times as long as alone robots take among others, about. In the paper's halls with 240 and 300
/// robots, first solutions cost least with 1.5.
constexpr double kAmongOthers = 1.5;
/// The weight of estimates when a way past goals is searched. A tenth of the expansions of weight 1 suffice,
/// for ways that serve as well.
constexpr double kWeight = 1.1;
/// Expansions of one search between two checks of the stop condition.
constexpr std::int64_t kStopStride = 256;

/// A robot passes the goal of another one.
struct Passage {
  std::size_t other;
  double t_end = 0.0;  // seconds: when it has passed, alone on the map
};

/// What is known of one robot.
struct Expected {
  bool has_way = false;
  double arrival = 0.0;  // seconds: when it rests for good
  std::vector<Passage> passages;
};

class ExpectedArrivals {
 public:
  /// The arguments outlive this object.
  ExpectedArrivals(PlanState& state, const PriorityOrder& robots)
      : state_(state),
        instance_(state.instance()),
        robots_(robots),
        expected_(instance_.size()),
        buckets_(instance_.problem().grid().width(), instance_.problem().grid().height(), bucket_size()),
        goals_in_(buckets_.count()) {
    for (const std::size_t robot : robots) {
      if (instance_.robot(robot).yields()) continue;  // it does not stay where others pass
      goals_in_[buckets_.at(goal_of(robot))].push_back(robot);
    }
  }

  /// Returns the robots in their order; none if `stop` is met first.
  std::optional<PriorityOrder> order(const StopCondition& stop) {
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (stop.met() || !find_way_alone(robots_[k], stop)) return std::nullopt;
      state_.memory().expect_use(robots_[k], static_cast<std::int64_t>(k));
    }
    PriorityOrder order = robots_;
    const auto rank = [&](std::size_t robot) {
      return rank_by_time(instance_.robot(robot), expected_[robot].arrival);
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rank(a) < rank(b); });
    std::vector<PriorityOrder> passing(instance_.size());  // by robot: those who pass its goal
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t robot = order[k];
      if (stop.met() || !choose_way(robot, stop)) return std::nullopt;
      state_.memory().expect_use(robot, static_cast<std::int64_t>(k));
      for (const Passage& passage : expected_[robot].passages) {
        if (!delays(passage)) continue;
        passing[passage.other].push_back(robot);
        expected_[passage.other].arrival = kAmongOthers * passage.t_end;
      }
    }
    std::vector<double> ranks(instance_.size(), 0.0);
    for (auto robot = order.rbegin(); robot != order.rend(); ++robot) {
      ranks[*robot] = rank(*robot);
      // Bounded: the passages, which were found one by one.
      for (const std::size_t other : passing[*robot]) {
        ranks[*robot] = std::max(ranks[*robot], ranks[other] + kAfter);
      }
    }
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return ranks[a] < ranks[b]; });
    return order;
  }

 private:
  /// Seconds by which a robot ranks behind those who pass its goal.
  static constexpr double kAfter = 1e-6;

  /// How a search for a way has come to a vertex.
  struct Label {
    double cost = kForever;  // seconds: the way and what it costs others
    double time = 0.0;       // seconds: the way alone
    int from = -1;
    bool closed = false;
  };
  using Open = std::pair<double, int>;  // estimated cost, vertex

  const Position& goal_of(std::size_t robot) const { return instance_.robot(robot).goal->position; }
  double resting_radius(std::size_t robot) const {
    const RobotStages& stages = instance_.stages(robot);
    return stages[instance_.itinerary(robot).goals.size()].motion.pair_radius;
  }
  double bucket_size() {
    for (const std::size_t robot : robots_) widest_ = std::max(widest_, resting_radius(robot));
    return std::max(2.0 * widest_, instance_.problem().grid().resolution());
  }

  /// Whether the robot whose goal is passed has to wait for it.
  bool delays(const Passage& passage) const { return delay(passage) > 0.0; }
  double delay(const Passage& passage) const {
    return std::max(0.0, kAmongOthers * passage.t_end - expected_[passage.other].arrival);
  }

  /// Finds the way of a robot alone on the map. Returns false if `stop` is met first.
  bool find_way_alone(std::size_t robot, const StopCondition& stop) {
    const Way& way = state_.ways().way_to_goal(robot, std::numeric_limits<std::int64_t>::max(), stop);
    if (way.kind == Way::Kind::unknown) return false;
    if (way.none()) return true;  // it comes first, so that the others are planned around it
    SearchSpace* space = state_.memory().space_of(robot, stop);
    if (space == nullptr) return false;
    double t = space->t_begin();
    double heading = space->heading_at_start();
    for (std::size_t stage = 0; stage < space->goal_count() && !space->goal(stage).anywhere; ++stage) {
      const int start = space->begin_of(stage);
      if (start != space->goal_pose(stage).vertex) {
        CostToGo& to_go = space->cost_to_go(stage);
        if (to_go.from(start, stop).least() == kForever) return !stop.met();
        const std::vector<int> vertices = to_go.way(start);
        if (vertices.empty()) return false;
        follow(robot, *space, stage, vertices, heading, t);
      }
      if (const auto& last = space->goal_pose(stage).heading) {
        t += space->vertices(stage).motion().rotation_time(heading, *last);
        heading = *last;
      }
      t = std::max(t, space->goal(stage).not_before) + space->goal(stage).service;
    }
    expected_[robot].has_way = true;
    expected_[robot].arrival = t;
    return true;
  }

  /// Follows the way of one stage from `t` (seconds) on, and notes which goals it passes.
  void follow(std::size_t robot, const SearchSpace& space, std::size_t stage, const std::vector<int>& way,
              double& heading, double& t) {
    const Vertices& vertices = space.vertices(stage);
    int here = space.begin_of(stage);
    for (const int next : way) {
      const Displacement move = vertices.between(here, next);
      const Segment path{vertices.position(here), vertices.position(next)};
      t += vertices.motion().rotation_time(heading, move.heading);
      const double t_start = t;
      t += vertices.times().translation_time(move.length, [&] { return path; });
      note_passages(robot, stage, {path, t_start, t});
      heading = move.heading;
      here = next;
    }
  }

  /// Notes which goals the robot passes on a move.
  void note_passages(std::size_t robot, std::size_t stage, const TimedSegment& move) {
    if (!(move.duration() > 0.0)) return;
    const double radius = instance_.stages(robot)[stage].motion.pair_radius;
    const MovingDisk disk(move);
    buckets_.cover(disk, radius + widest_, [&](std::size_t bucket, double, double) {
      for (const std::size_t other : goals_in_[bucket]) {
        if (other == robot) continue;
        const UnsafeInterval passing = unsafe_interval(goal_of(other), disk, radius + resting_radius(other));
        if (!passing.empty()) expected_[robot].passages.push_back({other, passing.end});
      }
    });
  }

  /// Chooses the way of a robot for which the cost is least. Returns false if `stop` is met first.
  bool choose_way(std::size_t robot, const StopCondition& stop) {
    Expected& expected = expected_[robot];
    const bool costs_others = std::any_of(expected.passages.begin(), expected.passages.end(),
                                          [&](const Passage& passage) { return delays(passage); });
    if (!expected.has_way || !costs_others) return true;
    SearchSpace* space = state_.memory().space_of(robot, stop);
    if (space == nullptr) return false;
    expected.passages.clear();
    double t = space->t_begin();
    for (std::size_t stage = 0; stage < space->goal_count(); ++stage) {
      if (space->goal(stage).anywhere) break;
      if (!search(robot, *space, stage, t, stop)) return false;
      t = std::max(t, space->goal(stage).not_before) + space->goal(stage).service;
    }
    return true;
  }

  /// Searches the way of one stage from `t` (seconds) on, and notes which goals it passes (A*; Hart, Nilsson
  /// and Raphael, 1968). Returns false if `stop` is met first.
  bool search(std::size_t robot, SearchSpace& space, std::size_t stage, double& t,
              const StopCondition& stop) {
    const Vertices& vertices = space.vertices(stage);
    const int start = space.begin_of(stage);
    const int goal = space.goal_pose(stage).vertex;
    if (start == goal) return true;
    PagedArray<Label> labels(static_cast<std::size_t>(vertices.count()));
    const auto label = [&](int vertex) -> Label& { return labels[static_cast<std::size_t>(vertex)]; };
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    label(start) = {0.0, t, -1, false};
    open.emplace(0.0, start);
    for (std::int64_t step = 1; !open.empty() && open.top().second != goal; ++step) {
      if (step % kStopStride == 0 && stop.met()) return false;
      const int here = open.top().second;
      open.pop();
      if (std::exchange(label(here).closed, true)) continue;
      const Label from = label(here);
      vertices.for_each_neighbour(here, [&](int next) {
        if (label(next).closed || !vertices.allow(here, next)) return;
        const Segment path{vertices.position(here), vertices.position(next)};
        const double duration = path.length() / vertices.times().linear_speed(path.from);
        double cost = from.cost + duration;
        for_each_entered(robot, stage, {path, from.time, from.time + duration},
                         [&](const Passage& passage) { cost += share_of(robot, passage); });
        if (!(cost < label(next).cost)) return;
        label(next) = {cost, from.time + duration, here, false};
        open.emplace(cost + kWeight * to_go(space, stage, next, stop), next);
      });
    }
    if (open.empty()) return true;  // the lattice has other ways than the estimates
    t = label(goal).time;
    for (int vertex = goal; vertex != start; vertex = label(vertex).from) {
      const int from = label(vertex).from;
      const TimedSegment move{
          {vertices.position(from), vertices.position(vertex)}, label(from).time, label(vertex).time};
      for_each_entered(robot, stage, move,
                       [&](const Passage& passage) { expected_[robot].passages.push_back(passage); });
    }
    return true;
  }

  static double to_go(SearchSpace& space, std::size_t stage, int vertex, const StopCondition& stop) {
    if (vertex == space.goal_pose(stage).vertex) return 0.0;
    return space.cost_to_go(stage).from(vertex, stop).least();
  }

  /// What the robot loses for which another one has to wait, in its own time; seconds.
  double share_of(std::size_t robot, const Passage& passage) const {
    return delay(passage) * instance_.robot(passage.other).weight / instance_.robot(robot).weight;
  }

  /// Calls visit(Passage) for the goals that the robot comes near at the end of a move, and not before.
  template <class Visitor>
  void for_each_entered(std::size_t robot, std::size_t stage, const TimedSegment& move,
                        Visitor&& visit) const {
    const Motion& motion = instance_.stages(robot)[stage].motion;
    const Position& here = move.path.to;
    const MovingDisk at_end({{here, here}, move.t_end, move.t_end});
    buckets_.cover(at_end, motion.pair_radius + widest_, [&](std::size_t bucket, double, double) {
      for (const std::size_t other : goals_in_[bucket]) {
        const double reach = motion.pair_radius + resting_radius(other);
        const bool enters =
            (goal_of(other) - here).norm() < reach && (goal_of(other) - move.path.from).norm() >= reach;
        if (enters && other != robot) visit(Passage{other, move.t_end + motion.cruise_time(2.0 * reach)});
      }
    });
  }

  PlanState& state_;
  const Instance& instance_;
  const PriorityOrder& robots_;     // by their ranks on straight lines
  std::vector<Expected> expected_;  // by robot
  double widest_ = 0.0;             // metres: the largest resting radius
  BucketGrid buckets_;
  std::vector<std::vector<std::size_t>> goals_in_;  // robots by the buckets of their goals
};

}  // namespace

PriorityOrder order_by_expected_arrival(PlanState& state, PriorityOrder robots, const StopCondition& stop) {
  const auto order = state.memory().within_memory(
      std::optional<PriorityOrder>(), [&] { return ExpectedArrivals(state, robots).order(stop); });
  return order ? *order : robots;
}

}  // namespace fleetplan::core
