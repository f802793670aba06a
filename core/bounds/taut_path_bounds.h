#pragma once

// Lower bounds of costs among obstacles, by taut paths.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/bounds/corner_visibility.h"
#include "core/bounds/lower_bound.h"
#include "core/bounds/tangent_graph.h"
#include "core/map/line_of_sight.h"
#include "core/runtime/arrays.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

class Instance;

/// A lower bound of the cost of every path.
struct TautPathResult {
  double seconds = 0.0;
  bool cut_off = false;  // the stop condition was met first
};

/// The cheapest taut path of a robot that is alone on the static map and may turn anywhere, arcs included.
/// Its cost is a lower bound of the cost of the robot's plans. A* (Hart, Nilsson and Raphael, 1968) on the
/// tangent graph (Liu and Arimoto, IJRR 1992), with the straight cost as the heuristic.
///
/// Take all obstacles, grown by the radius. Paths that can be deformed into each other without crossing them
/// form a class. The taut path of a class has the least length and the least total rotation of the class
/// (docs/proofs.md, Lemma 2). Suppose that it bends, and that k of its straight pieces lie between bends of
/// opposite sense. Then every path of the class has at least k + 2 translations, each with an added wait
/// (Lemma 3). So no plan costs less than the cheapest taut path.
class TautPathSearch {
 public:
  /// Searches taut paths of robots of one radius (metres).
  TautPathSearch(CornerVisibility& corners, const LineOfSight& sight, double radius,
                 bool stops_at_cell_centers = true)
      : corners_(corners), graph_(corners, sight, radius, stops_at_cell_centers) {}

  /// Returns the lower bound for a leg whose end is not in sight of its begin. `body` has the robot's radius
  /// and speeds. `known_cost` is the cost of a known path in seconds (infinite for none). Paths that cost
  /// more are not explored. After `max_work`, or when `stop` is met, returns the bound that is proved by
  /// then.
  TautPathResult run(const GoalLeg& leg, const Body& body, double known_cost, std::int64_t max_work,
                     const StopCondition& stop);

  /// The work done so far by this search and by `corners`, in steps of 10 to 20 ns.
  std::int64_t work() const { return steps_ * kStepWork + graph_.work() + corners_.work(); }

 private:
  static constexpr int kStepWork = 3;  // work of examining one tangent; measured

  struct Arrival {
    double seconds = 0.0;
    double angle = 0.0;  // the place on the bend
    Bend bend;
    int untested = -1;  // in from_start_: the move by which it arrives, if it is not known to be free
    int next = -1;      // the next one in the list of tested arrivals at the same bend, or -1
    bool at_goal = false;
  };
  struct Open {
    double f;
    int arrival;
    bool operator>(const Open& other) const { return f != other.f ? f > other.f : arrival > other.arrival; }
  };

  void reset();
  void expand_start();
  void expand(int index);
  void expand_tangents(const Arrival& arrival);
  void expand_goal(const Arrival& arrival);
  double seconds_after(const Arrival& arrival, const Tangent& tangent) const;
  bool exceeds_limit(double seconds, const Position& end) const;
  bool push(const Arrival& arrival, const Tangent& by);
  void add_to_bend(int index);
  bool is_dominated(const Bend& bend, double angle, double seconds, int except) const;

  CornerVisibility& corners_;
  TangentGraph graph_;
  std::int64_t steps_ = 0;  // tangents examined

  // The members below belong to the current search. They are members so that their memory is reused.
  const GoalLeg* leg_ = nullptr;
  Body body_;                         // without inertia of translations
  double bend_time_ = 0.0;            // seconds for a radian of an arc
  double limit_ = 0.0;                // seconds; paths that cost more are not explored
  IndexedVector<char> goal_visible_;  // by corner
  IndexedVector<Tangent> from_start_;
  IndexedVector<Arrival> arrivals_;
  std::vector<Open> open_;           // a heap
  IndexedVector<int> last_arrival_;  // by bend, the head of its list
};

/// Lower bounds of the costs of robots, each alone on the static map, seconds. They go from goal to goal,
/// with the services, after the committed actions. If the straight line is free, the bound is its cost with
/// the rotations. Otherwise, it is the cost of the cheapest taut path (see TautPathSearch).
class TautPathBounds {
 public:
  /// Bounds the costs of `robots`, which all have goals. `costs` are the costs of a known plan, by robot;
  /// infinite for none. The work is limited to about half a second, which large maps full of corners can
  /// exceed. Bounds are weaker, down to the straight line, beyond this limit, when `stop` is met, or when the
  /// memory is spent.
  TautPathBounds(const Instance& instance, const std::vector<std::size_t>& robots,
                 const std::vector<double>& costs, const StopCondition& stop);

  /// The lower bound of a robot's cost, seconds. 0 for a robot that was not among `robots`.
  double operator[](std::size_t robot) const { return seconds_[robot]; }
  /// Whether `stop` or a lack of memory weakened a bound.
  bool cut_off() const { return cut_off_; }

 private:
  struct Way;
  struct LegIndex {
    std::size_t robot;
    std::size_t way;
    std::size_t leg;
  };
  using LegsByRadius = std::map<double, std::vector<LegIndex>>;

  void bound(const Instance& instance, const std::vector<std::size_t>& robots,
             const std::vector<double>& costs, const StopCondition& stop);
  /// Replaces the bounds of these legs by the bounds of their taut paths.
  void improve(const Instance& instance, const LegsByRadius& out_of_sight, std::vector<Way>& ways,
               const std::vector<double>& costs, const StopCondition& stop);

  std::vector<double> seconds_;  // by robot
  bool cut_off_ = false;
};

}  // namespace fleetplan::core
