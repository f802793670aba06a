#include "core/moves/expected_arrivals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "core/compile/instance.h"
#include "core/fleet/search_memory.h"
#include "core/fleet/static_ways.h"
#include "core/geometry/bucket_grid.h"
#include "core/geometry/disk_motion.h"
#include "core/geometry/tolerance.h"
#include "core/runtime/arrays.h"

namespace fleetplan::core {
namespace {

/// How many times as long as alone robots take among others, about. In the paper's halls with 240 and 300
/// robots, 1.25 to 2.2 make no difference.
constexpr double kAmongOthers = 1.5;
/// The weight of estimates when another way is searched. A tenth of the expansions of weight 1 suffice, for
/// ways that serve as well.
constexpr double kWeight = 1.1;
/// Expansions of these searches for each robot, on average: halls with 300 robots take less. No more ways are
/// chosen after that.
constexpr std::int64_t kMaxExpansions = 400;
/// Expansions or passages between two checks of the stop condition.
constexpr std::size_t kStopStride = 64;
/// Rank by which a robot is behind the robots that pass its goal. Then, how often ranks are raised because
/// the ranks of other robots were raised: robots that wait for each other never come to an end.
constexpr double kBehind = 1e-6;
constexpr int kMaxSweeps = 8;

/// A robot passes the goal of another robot.
struct Passage {
  std::size_t other = 0;
  std::size_t stage = 0;
  double t_end = 0.0;  // seconds: when it has passed, alone on the map
  Segment path;        // of the move on which it passes
};

/// What is expected of one robot.
struct Expected {
  bool has_way = false;
  double arrival = 0.0;  // seconds: when it comes to rest for good
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
        expansions_left_(kMaxExpansions * static_cast<std::int64_t>(robots.size())),
        buckets_(instance_.problem().grid().width(), instance_.problem().grid().height(), bucket_size()),
        goals_in_(buckets_.count()) {
    for (const std::size_t robot : robots) {
      if (instance_.itinerary(robot).yields()) continue;  // it does not stay where others pass
      goals_in_[buckets_.at(goal_of(robot))].push_back(robot);
    }
  }

  ExpectedOrder order(const StopCondition& stop) {
    if (!find_ways_alone(stop)) return {robots_, stop.met()};
    PriorityOrder order = robots_;
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rank(a) < rank(b); });
    std::vector<PriorityOrder> passing(instance_.size());  // by robot: the robots that pass its goal
    for (std::size_t k = 0; k < order.size() && !is_memory_full(); ++k) {
      const std::size_t robot = order[k];
      if (stop.met() || !choose_way(robot, stop)) break;
      state_.memory().expect_use(robot, static_cast<std::int64_t>(k));
      for (const Passage& passage : expected_[robot].passages) {
        if (!(delay(passage) > 0.0)) continue;
        passing[passage.other].push_back(robot);
        expected_[passage.other].arrival = kAmongOthers * passage.t_end;
      }
    }
    const std::vector<double> ranks = ranks_behind(passing);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return ranks[a] < ranks[b]; });
    return {order, stop.met()};
  }

 private:
  /// How a search for a way has come to a vertex.
  struct Label {
    double cost = kForever;  // seconds: the way and what it costs others
    double time = 0.0;       // seconds: the way alone
    int from = -1;
    bool closed = false;
  };
  using Open = std::pair<double, int>;  // estimated cost, vertex

  const Position& goal_of(std::size_t robot) const { return instance_.itinerary(robot).last_goal().position; }
  double resting_radius(std::size_t robot) const {
    const Views& views = instance_.views(robot);
    return views[instance_.itinerary(robot).goals.size()].body.pair_radius;
  }
  double rank(std::size_t robot) const {
    return rank_by_time(instance_.itinerary(robot), expected_[robot].arrival);
  }

  /// So large that a disk comes near few buckets, and that there are not many more buckets than robots.
  double bucket_size() {
    double widest = 0.0;
    for (const std::size_t robot : robots_) {
      widest = std::max(widest, instance_.views(robot).largest_disk().pair_radius);
      widest_at_rest_ = std::max(widest_at_rest_, resting_radius(robot));
    }
    constexpr double kBucketsPerRobot = 4.0;
    const OccupancyGrid& grid = instance_.problem().grid();
    const double robots = static_cast<double>(std::max<std::size_t>(robots_.size(), 1));
    const double few = std::sqrt(grid.width() * grid.height() / (kBucketsPerRobot * robots));
    return std::max({2.0 * widest, few, grid.resolution()});
  }

  /// Whether search spaces were discarded since this began.
  bool is_memory_full() const { return state_.memory().discarded() > discarded_before_; }

  /// For how long the robot whose goal is passed has to wait for that, seconds.
  double delay(const Passage& passage) const {
    const Expected& other = expected_[passage.other];
    return other.has_way ? std::max(0.0, kAmongOthers * passage.t_end - other.arrival) : 0.0;
  }

  /// Ranks each robot behind the robots that pass its goal.
  std::vector<double> ranks_behind(const std::vector<PriorityOrder>& passing) const {
    std::vector<double> ranks(instance_.size(), 0.0);
    for (const std::size_t robot : robots_) ranks[robot] = rank(robot);
    bool changed = true;
    // Bounded: a few times the passages, which were found one by one.
    for (int sweep = 0; changed && sweep < kMaxSweeps; ++sweep) {
      changed = false;
      for (const std::size_t robot : robots_) {
        for (const std::size_t other : passing[robot]) {
          if (ranks[robot] > ranks[other]) continue;
          ranks[robot] = ranks[other] + kBehind;
          changed = true;
        }
      }
    }
    return ranks;
  }

  /// Returns false if `stop` is met first, or if the search spaces of all robots need too much memory. Then
  /// the spaces of the first robots are kept.
  bool find_ways_alone(const StopCondition& stop) {
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (stop.met() || !find_way_alone(robots_[k], stop) || is_memory_full()) return false;
      state_.memory().expect_use(robots_[k], static_cast<std::int64_t>(k));
    }
    return true;
  }

  /// Finds the way of a robot alone on the map. Returns false if `stop` is met first.
  bool find_way_alone(std::size_t robot, const StopCondition& stop) {
    const Way& known = state_.ways().way_to_goal(robot, std::numeric_limits<std::int64_t>::max(), stop);
    if (known.kind == Way::Kind::unknown) return false;
    if (known.none()) return true;  // it comes first, so that the others are planned around it
    SearchSpace* space = state_.memory().space_of(robot, stop);
    if (space == nullptr) return false;
    double t = space->t_begin();
    double heading = space->heading_at_start();
    for (std::size_t stage = 0; stage < space->goal_count() && !space->goal(stage).anywhere; ++stage) {
      const Vertices& vertices = space->vertices(stage);
      const int start = space->begin_of(stage);
      const Vertices::GoalPose& goal = space->goal_pose(stage);
      if (start != goal.vertex) {
        if (space->cost_to_go(stage).from(start, stop).least() == kForever) return !stop.met();
        std::vector<int> way = space->cost_to_go(stage).way(start);
        if (stop.met()) return false;
        if (way.empty()) way = {goal.vertex};
        follow(robot, stage, vertices, start, way, heading, t);
      }
      if (goal.heading) {
        t += vertices.times().rotation_time(vertices.position(goal.vertex), heading, *goal.heading);
        heading = *goal.heading;
      }
      t = space->goal(stage).service_end(t);
    }
    expected_[robot].has_way = true;
    expected_[robot].arrival = t;
    return true;
  }

  /// Follows a way from `here` and from `t` (seconds) on, and notes which goals it passes.
  void follow(std::size_t robot, std::size_t stage, const Vertices& vertices, int here,
              const std::vector<int>& way, double& heading, double& t) {
    for (const int next : way) {
      const Displacement move = vertices.between(here, next);
      const Segment path{vertices.position(here), vertices.position(next)};
      t += vertices.times().rotation_time(path.from, heading, move.heading);
      const double t_start = t;
      t += vertices.times().translation_time(move.length, [&]() -> const Segment& { return path; });
      for_each_passed(robot, stage, {path, t_start, t},
                      [&](const Passage& passage) { expected_[robot].passages.push_back(passage); });
      heading = move.heading;
      here = next;
    }
  }

  /// Calls visit(Passage) for the goals that the robot passes on a move.
  template <class Visitor>
  void for_each_passed(std::size_t robot, std::size_t stage, const TimedSegment& move,
                       Visitor&& visit) const {
    const double radius = instance_.views(robot)[stage].body.pair_radius;
    const MovingDisk disk(move);
    buckets_.cover(disk, radius + widest_at_rest_, [&](std::size_t bucket, double, double) {
      for (const std::size_t other : goals_in_[bucket]) {
        if (other == robot) continue;
        const UnsafeInterval passing = unsafe_interval(goal_of(other), disk, radius + resting_radius(other));
        if (!passing.empty()) visit(Passage{other, stage, passing.end, move.path});
      }
    });
  }

  /// Chooses the way of a robot for which the cost is least. Returns false if `stop` is met first, or if no
  /// more ways are chosen.
  bool choose_way(std::size_t robot, const StopCondition& stop) {
    Expected& expected = expected_[robot];
    StopStride stride(stop, kStopStride);
    std::erase_if(expected.passages, [&](const Passage& passage) {
      if (stride.met_at_step()) return false;
      return !(delay(passage) > 0.0) || has_room_beside(robot, passage);
    });
    if (stride.met()) return false;
    if (expected.passages.empty()) return true;
    SearchSpace* space = state_.memory().space_of(robot, stop);
    if (space == nullptr) return false;
    const std::vector<Passage> before = std::exchange(expected.passages, {});
    double t = space->t_begin();
    for (std::size_t stage = 0; stage < space->goal_count() && !space->goal(stage).anywhere; ++stage) {
      if (!search(robot, *space, stage, t, stop, stride)) {
        expected.passages = before;
        return !stop.met() && expansions_left_ > 0;
      }
      t = space->goal(stage).service_end(t);
    }
    return true;
  }

  /// Whether the robot can get around a goal for less than the goal's robot would lose: in two straight moves
  /// beside it, past the obstacles and other goals.
  bool has_room_beside(std::size_t robot, const Passage& passage) const {
    const View& view = instance_.views(robot)[passage.stage];
    const double reach = view.body.pair_radius + resting_radius(passage.other);
    const Position way = passage.path.to - passage.path.from;
    const Position along = way.normalized();
    const Position across(-along.y(), along.x());
    const double offset = (passage.path.from - goal_of(passage.other)).dot(across);
    const Position beside = goal_of(passage.other) + offset * across;
    const Position before = beside - 2.0 * reach * along;
    const Position after = beside + 2.0 * reach * along;
    for (const double side : {1.0, -1.0}) {
      const Position around = goal_of(passage.other) + side * (reach + kContactTolerance) * across;
      const double longer = (around - before).norm() + (after - around).norm() - (after - before).norm();
      if (view.body.cruise_time(longer) > share_of(robot, passage)) continue;
      if (is_free(robot, {before, around}, passage) && is_free(robot, {around, after}, passage)) return true;
    }
    return false;
  }

  /// Whether the robot can make this move at about the time of a passage without meeting another robot.
  bool is_free(std::size_t robot, const Segment& path, const Passage& passage) const {
    const View& view = instance_.views(robot)[passage.stage];
    if (!view.free_space->may_sweep(path.from, path.to, view.body.wall_radius)) return false;
    bool is_free = true;
    const double duration = view.body.cruise_time(path.length());
    for_each_passed(robot, passage.stage, {path, passage.t_end, passage.t_end + duration},
                    [&](const Passage& next) {
                      if (next.other != passage.other && delay(next) > 0.0) is_free = false;
                    });
    return is_free;
  }

  /// Searches the way of one stage from `t` (seconds) on, and notes which goals it passes (A*; Hart, Nilsson
  /// and Raphael, 1968). Returns false if it finds none, or if `stop` is met first.
  bool search(std::size_t robot, SearchSpace& space, std::size_t stage, double& t, const StopCondition& stop,
              StopStride& stride) {
    const Vertices& vertices = space.vertices(stage);
    const int start = space.begin_of(stage);
    const int goal = space.goal_pose(stage).vertex;
    if (start == goal) return true;
    PagedArray<Label> labels(static_cast<std::size_t>(vertices.count()));
    const auto label = [&](int vertex) -> Label& { return labels[static_cast<std::size_t>(vertex)]; };
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    label(start) = {0.0, t, -1, false};
    open.emplace(0.0, start);
    for (; !open.empty() && open.top().second != goal; --expansions_left_) {
      if (expansions_left_ <= 0 || stride.met_at_step()) return false;
      const int here = open.top().second;
      open.pop();
      if (std::exchange(label(here).closed, true)) continue;
      const Label from = label(here);
      vertices.for_each_neighbour(here, [&](int next) {
        if (label(next).closed || !vertices.allow(here, next) || !vertices.may_visit(next, goal)) return;
        const TimedSegment move = lattice_move(vertices, here, next, from.time);
        double cost = from.cost + move.duration();
        for_each_entered(robot, stage, move,
                         [&](const Passage& passage) { cost += share_of(robot, passage); });
        if (!(cost < label(next).cost)) return;
        label(next) = {cost, move.t_end, here, false};
        open.emplace(cost + kWeight * to_go(space, stage, next, stop), next);
      });
    }
    if (open.empty()) return false;
    t = label(goal).time;
    for (int vertex = goal; vertex != start; vertex = label(vertex).from) {
      const int from = label(vertex).from;
      for_each_entered(robot, stage, lattice_move(vertices, from, vertex, label(from).time),
                       [&](const Passage& passage) { expected_[robot].passages.push_back(passage); });
    }
    return true;
  }

  static TimedSegment lattice_move(const Vertices& vertices, int from, int to, double t) {
    const Segment path{vertices.position(from), vertices.position(to)};
    return {path, t, t + path.length() / vertices.times().linear_speed(path.from)};
  }

  static double to_go(SearchSpace& space, std::size_t stage, int vertex, const StopCondition& stop) {
    if (vertex == space.goal_pose(stage).vertex) return 0.0;
    return space.cost_to_go(stage).from(vertex, stop).least();
  }

  /// What another robot loses because it waits for this one, in the time of this one; seconds.
  double share_of(std::size_t robot, const Passage& passage) const {
    return delay(passage) * instance_.itinerary(passage.other).weight / instance_.itinerary(robot).weight;
  }

  /// Calls visit(Passage) for the goals that the robot comes near at the end of a lattice move, and not
  /// before. Goals that it is near where a way begins are left out.
  template <class Visitor>
  void for_each_entered(std::size_t robot, std::size_t stage, const TimedSegment& move,
                        Visitor&& visit) const {
    const Body& body = instance_.views(robot)[stage].body;
    const Position& here = move.path.to;
    const MovingDisk at_end({{here, here}, move.t_end, move.t_end});
    buckets_.cover(at_end, body.pair_radius + widest_at_rest_, [&](std::size_t bucket, double, double) {
      for (const std::size_t other : goals_in_[bucket]) {
        const double reach = body.pair_radius + resting_radius(other);
        const bool enters =
            (goal_of(other) - here).norm() < reach && (goal_of(other) - move.path.from).norm() >= reach;
        if (!enters || other == robot) continue;
        visit(Passage{other, stage, move.t_end + body.cruise_time(2.0 * reach), move.path});
      }
    });
  }

  PlanState& state_;
  const Instance& instance_;
  const PriorityOrder& robots_;
  const std::int64_t discarded_before_ = state_.memory().discarded();
  std::vector<Expected> expected_;  // by robot
  std::int64_t expansions_left_;
  double widest_at_rest_ = 0.0;  // metres: the largest radius at rest
  BucketGrid buckets_;
  std::vector<PriorityOrder> goals_in_;  // robots by the buckets of their goals
};

}  // namespace

ExpectedOrder order_by_expected_arrival(PlanState& state, const PriorityOrder& robots,
                                        const StopCondition& stop) {
  return state.memory().within_memory(ExpectedOrder{robots, true},
                                      [&] { return ExpectedArrivals(state, robots).order(stop); });
}

}  // namespace fleetplan::core
