#pragma once

#include <cstdint>
#include <vector>

#include "core/bounds/corner_sight.h"
#include "core/bounds/tangents.h"
#include "core/instance.h"
#include "core/model/robot.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// What a search for the cheapest taut path found out: no path costs less. `cut_off`: stopped by the clock.
struct TautResult {
  double seconds = 0.0;
  bool cut_off = false;
};

/// The cheapest taut path of a robot that is alone on the static map and may turn anywhere, arcs included: a
/// lower bound of the cost of its plans. A* over tangents (after Hart, Nilsson and Raphael, 1968, and the
/// tangent graph of Liu and Arimoto, IJRR 1992), with the straight cost as the estimate of what is left.
///
/// Why no plan costs less. Obstacles grown by the radius leave the centre a region, whose paths from start to
/// goal fall into classes of those that can be deformed into each other. (1) Length and turning: put a
/// tight convex chain of the triangle a, b, c around what lies in it in place of a corner a-b-c of a path.
/// The path gets no longer. Its headings stay on the shorter arc between those of ab and bc, in order, so by
/// the triangle inequality it turns no more, the turns from the start heading and to the goal heading
/// included. Repeated, this leads to the taut path of the class, which therefore has the least length and
/// the least turning of its class at once (in the limit of polygons that fill the grown obstacles; total
/// turning is lower semicontinuous). (2) Translations, each of which may need a wait: prolong a straight
/// piece of the taut path between bends of opposite sense, which touches obstacles at u on one side and v on
/// the other, to a chord of the region. All paths of the class cross the chord before u and beyond v in one
/// sense, so between u and v in the other, or run along it there: with a translation of its own, since the
/// taut path is the only taut one between any two of its points. By the same reason it is neither the first
/// nor the last one. So there are at least two translations more than such pieces, if the path bends at all.
class TautSearch {
 public:
  /// For robots of one radius.
  TautSearch(CornerSight& corners, const LineOfSight& sight, double radius)
      : corners_(corners), tangents_(corners, sight, radius) {}

  /// `motion` has the radius, and the robot a goal, which it does not see. `at_most`: the cost of a plan,
  /// seconds, beyond which nobody looks; infinite if none is known. After `most_work`, or when `stop` is
  /// met, the bound is what is known by then.
  TautResult run(const Robot& robot, const Motion& motion, double at_most, std::int64_t most_work,
                 const StopCondition& stop);

  /// The work done so far by this and by `corners`, a step taking 10 to 20 ns.
  std::int64_t work() const { return steps_ * kStepWork + tangents_.work() + corners_.work(); }

 private:
  static constexpr int kStepWork = 3;  // to look at a tangent; measured

  struct Arrival {
    double seconds = 0.0;
    double place = 0.0;  // on the bend
    Bend bend;
    int untested = -1;  // in from_start_: the move by which it arrives, if that is not known to be free
    int next = -1;      // another one at the same bend that was put on the open list and is tested, or -1
    bool at_goal = false;
  };
  struct Open {
    double f;
    int arrival;
    bool operator>(const Open& other) const { return f != other.f ? f > other.f : arrival > other.arrival; }
  };

  void reset();
  void leave_start();
  void expand(int index);
  void go_on(const Arrival& arrival);
  void reach_goal(const Arrival& arrival);
  double seconds_after(const Arrival& arrival, const Tangent& tangent) const;
  bool too_far(double seconds, const Position& end) const;
  bool push(const Arrival& arrival, const Tangent& by);
  void enlist(int index);
  bool better_known(const Bend& bend, double place, double seconds, int except) const;

  CornerSight& corners_;
  Tangents tangents_;
  std::int64_t steps_ = 0;  // tangents that were looked at

  // Of the search at hand; kept between searches for their memory.
  const Robot* robot_ = nullptr;
  const Motion* motion_ = nullptr;
  double bend_time_ = 0.0;       // seconds for a radian of an arc
  double limit_ = 0.0;           // seconds; what costs more is not looked at
  std::vector<char> sees_goal_;  // by corner
  std::vector<Tangent> from_start_;
  std::vector<Arrival> arrivals_;
  std::vector<Open> open_;
  std::vector<int> arrivals_at_;  // by bend, the last of its list
};

}  // namespace fleetplan::core
