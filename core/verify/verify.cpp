#include "core/verify/verify.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"
#include "core/verify/execution.h"
#include "core/verify/geometry/relative_motion.h"
#include "core/verify/pairs/fleet_clearance.h"
#include "core/verify/pairs/sweeps.h"
#include "core/verify/rules/robot_rules.h"

namespace fleetplan::core {

namespace {

/// The collisions of robots with each other and with moving obstacles.
struct PairReport {
  ViolationList violations;
  std::optional<double> min_clearance;  // see VerifyReport
};

// The functions below judge robots that begin nearer to each other than they have to keep.

/// Returns the legs until the commitment ends; from then on the robot stays.
std::vector<Leg> committed_legs(const std::vector<Leg>& legs, double until) {
  std::vector<Leg> kept;
  for (const Leg& leg : legs) {
    if (leg.t_begin >= until && !kept.empty()) break;
    kept.push_back(leg);
  }
  if (kept.back().t_end < until) return kept;  // the robot has another radius from then on
  Leg& last = kept.back();
  const Position end = position_at(last, until);
  last = part_of(last, last.t_begin, until);
  kept.push_back({until, std::numeric_limits<double>::infinity(), end, end});
  return kept;
}

/// Returns the least distance of the committed motions, metres. Both bodies begin before `until`, or at that
/// time if a robot grows where its commitment ends.
double least_of_commitments(const ExecutedFleet& fleet, const Overlap& overlap, double until) {
  const auto& a = fleet.legs[overlap.first];
  const auto& b = fleet.legs[overlap.second];
  const double begin = std::max(a.front().t_begin, b.front().t_begin);
  if (until <= begin) {
    const Position apart =
        position_at(*first_leg_until(a, begin), begin) - position_at(*first_leg_until(b, begin), begin);
    return apart.norm();
  }
  return least_distance(committed_legs(a, fleet.handovers[overlap.first].committed_until),
                        committed_legs(b, fleet.handovers[overlap.second].committed_until), {0.0, until});
}

/// Returns the time, seconds, from which two robots that begin with this overlap have to keep their whole
/// distance. None if they may not leave the overlap.
std::optional<double> leaves_overlap(const ExecutedFleet& fleet, const Overlap& overlap,
                                     const CheckRules& rules) {
  const Handover& a = fleet.handovers[overlap.first];
  const Handover& b = fleet.handovers[overlap.second];
  const double bare = fleet.radii[overlap.first] + fleet.radii[overlap.second];
  const double kept = fleet.kept_distance(overlap.first, overlap.second, rules.inflation);
  if (kept <= bare && rules.start_overlap <= 0.0) return std::nullopt;
  // A robot that has got another radius since its plan began may not be so near.
  if (fleet.begin_of(overlap.first) > a.committed_until + kSameTime ||
      fleet.begin_of(overlap.second) > b.committed_until + kSameTime)
    return std::nullopt;
  const double tolerance = std::max(fleet.tolerances[overlap.first], fleet.tolerances[overlap.second]);
  const double moved = std::min(a.first_move_ends, b.first_move_ends);
  const double until = std::max(overlap.t_end, moved);
  if (overlap.distance < bare - tolerance) {
    const double inflated = bare + 2.0 * rules.inflation;
    const double at_start =
        (fleet.legs[overlap.first].front().from - fleet.legs[overlap.second].front().from).norm();
    const bool allowed = overlap.t_begin <= 0.0 && inflated - at_start <= rules.start_overlap + tolerance;
    return allowed && overlap.distance >= at_start - tolerance ? std::optional(until) : std::nullopt;
  }
  const double certain = std::max(a.committed_until, b.committed_until);
  const bool begins_so = overlap.t_begin <= certain + kSameTime;
  const bool first_moves = overlap.t_begin <= moved && overlap.t_end <= moved;
  if (!begins_so && !first_moves) return std::nullopt;
  const double least = least_of_commitments(fleet, overlap, certain);
  return overlap.distance >= least - tolerance ? std::optional(until) : std::nullopt;
}

/// The overlaps that are listed in addition for each robot, so that allowed overlaps at starts do not hide
/// others.
constexpr std::size_t kNearStartsPerRobot = 64;

std::string overlap_text(const Overlap& overlap, double contact, const std::string& what) {
  return what + metres(contact - overlap.distance) + " from t = " + seconds(overlap.t_begin) +
         (std::isfinite(overlap.t_end) ? " to " + seconds(overlap.t_end) : " on, for ever");
}

/// Compares robots with robots, also at slightly different times, and with moving obstacles.
class PairCheck {
 public:
  PairCheck(const ExecutedFleet& fleet, const std::vector<MovingObstacle>& obstacles, const CheckRules& rules,
            const StopCondition& stop)
      : fleet_(fleet),
        rules_(rules),
        stop_(stop),
        obstacles_(legs_of_all(obstacles)),
        radii_(radii(obstacles)),
        exemptions_(rules.exempt, fleet, rules.inflation, obstacles_, radii_, stop) {}

  std::optional<PairReport> run() {
    const bool finished = compare_robots() && compare_margin() && compare_obstacles();
    return finished ? std::optional(std::move(report_)) : std::nullopt;
  }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;

  static std::vector<std::vector<Leg>> legs_of_all(const std::vector<MovingObstacle>& obstacles) {
    std::vector<std::vector<Leg>> legs;
    legs.reserve(obstacles.size());
    for (const MovingObstacle& obstacle : obstacles) legs.push_back(legs_of(obstacle));
    return legs;
  }
  static std::vector<double> radii(const std::vector<MovingObstacle>& obstacles) {
    std::vector<double> all;
    all.reserve(obstacles.size());
    for (const MovingObstacle& obstacle : obstacles) all.push_back(obstacle.radius);
    return all;
  }

  double contact(std::size_t first, std::size_t second) const {
    return fleet_.kept_distance(first, second, rules_.inflation);
  }

  /// Returns the indices of two robots, ascending, like their positions.
  std::vector<std::size_t> robots(std::size_t first, std::size_t second) const {
    return {fleet_.robots[first], fleet_.robots[second]};
  }

  bool compare_robots() {
    std::vector<double> planned = fleet_.radii;
    for (std::size_t i = 0; i < fleet_.size(); ++i) planned[i] += rules_.inflation + fleet_.vicinities[i];
    const bool near_starts = planned != fleet_.radii || rules_.start_overlap > 0.0;
    const std::size_t invalid =
        static_cast<std::size_t>(std::count(fleet_.invalid.begin(), fleet_.invalid.end(), true));
    const std::size_t more = (near_starts ? fleet_.size() : 0) + invalid + rules_.exempt.size();
    const auto clearance = fleet_clearance(fleet_.legs, {fleet_.radii, planned}, fleet_.tolerances,
                                           kMaxCollisions + kNearStartsPerRobot * more, stop_,
                                           [this](const Overlap& overlap) { return may_rest(overlap); });
    if (!clearance) return false;
    const bool is_pair = !fleet_.robots.empty() && fleet_.robots.front() != fleet_.robots.back();
    if (is_pair) report_.min_clearance = clearance->least;
    std::size_t listed = 0;
    for (const Overlap& overlap : clearance->overlaps) {
      if (stop_.met()) return false;
      if (is_allowed(overlap) || ++listed > kMaxCollisions) continue;
      report(overlap);
    }
    return true;
  }

  bool is_exempt(const Overlap& overlap) const {
    const auto [first, second] = Pair(overlap.first, overlap.second);
    if (fleet_.invalid[first] && fleet_.invalid[second]) return true;
    return exemptions_.allow_robots(first, second, overlap.t_begin);
  }

  /// Whether the overlap of two robots that never move is allowed. The interval margin leaves them out.
  bool may_rest(const Overlap& overlap) const {
    return is_exempt(overlap) || leaves_overlap(fleet_, overlap, rules_).has_value();
  }

  bool is_allowed(const Overlap& overlap) {
    if (is_exempt(overlap)) return true;
    const auto [first, second] = Pair(overlap.first, overlap.second);
    const auto until = leaves_overlap(fleet_, overlap, rules_);
    if (!until) return false;
    double& left = left_at_[{first, second}];
    left = std::max(left, *until);
    return true;
  }

  void report(const Overlap& overlap) {
    const double kept = contact(overlap.first, overlap.second);
    collided_.insert({overlap.first, overlap.second});
    report_.violations.add({Violation::Kind::robot_collision,
                            robots(overlap.first, overlap.second),
                            overlap.t_deepest,
                            overlap.distance,
                            kept,
                            overlap_text(overlap, kept, "the disks overlap by "),
                            {},
                            overlap.t_begin});
  }

  bool compare_margin() {
    const TimesLeftOut left_out = [this](std::size_t first, std::size_t second) {
      return times_left_out(first, second);
    };
    const auto overlaps = overlaps_within_margin(fleet_, rules_.interval_margin, rules_.inflation, left_out,
                                                 kMaxCollisions, stop_);
    if (!overlaps) return false;
    for (const ShiftedOverlap& overlap : *overlaps) {
      if (collided_.contains({overlap.first, overlap.second})) continue;
      const double kept = contact(overlap.first, overlap.second);
      report_.violations.add({Violation::Kind::margin,
                              robots(overlap.first, overlap.second),
                              std::min(overlap.t_first, overlap.t_second),
                              overlap.distance,
                              kept,
                              "the disk of the one robot at t = " + seconds(overlap.t_first) +
                                  " overlaps that of the other at t = " + seconds(overlap.t_second) + " by " +
                                  metres(kept - overlap.distance) + ", but the interval margin is " +
                                  seconds(rules_.interval_margin),
                              {}});
    }
    return true;
  }

  std::vector<TimeSpan> times_left_out(std::size_t first, std::size_t second) const {
    std::vector<TimeSpan> times;
    const double margin = rules_.interval_margin;
    for (const TimeSpan& span : exemptions_.of_robots(first, second)) {
      times.push_back({span.begin - margin, span.end + margin});
    }
    const auto left = left_at_.find({first, second});
    if (left != left_at_.end()) times.push_back({-std::numeric_limits<double>::infinity(), left->second});
    return times;
  }

  bool compare_obstacles() {
    const auto overlaps = overlaps_with_obstacles(fleet_, obstacles_, radii_, exemptions_,
                                                  kMaxCollisions + rules_.exempt.size(), stop_);
    if (!overlaps) return false;
    std::size_t listed = 0;
    for (const Overlap& overlap : *overlaps) {
      if (exemptions_.allow_obstacle(overlap.first, overlap.second, overlap.t_begin)) continue;
      if (++listed > kMaxCollisions) break;
      const double kept = fleet_.radii[overlap.first] + radii_[overlap.second];
      report_.violations.add({Violation::Kind::moving_obstacle,
                              {fleet_.robots[overlap.first]},
                              overlap.t_deepest,
                              overlap.distance,
                              kept,
                              overlap_text(overlap, kept, "the disk overlaps the moving obstacle by "),
                              overlap.second});
    }
    return true;
  }

  const ExecutedFleet& fleet_;
  const CheckRules& rules_;
  const StopCondition& stop_;
  std::vector<std::vector<Leg>> obstacles_;
  std::vector<double> radii_;  // metres, by obstacle
  Exemptions exemptions_;
  PairReport report_;
  std::set<Pair> collided_;
  std::map<Pair, double> left_at_;  // seconds: when robots that begin too near have to keep their distance
};

/// Returns the plan of each robot, null where it has none.
std::vector<const RobotPlan*> plans_by_robot(std::size_t robots, const std::vector<RobotPlan>& plans) {
  std::vector<const RobotPlan*> by_robot(robots, nullptr);
  for (const RobotPlan& plan : plans) {
    if (plan.robot >= robots || by_robot[plan.robot] != nullptr) {
      throw std::invalid_argument("a plan of no robot, or a second one of the same robot");
    }
    by_robot[plan.robot] = &plan;
  }
  return by_robot;
}

/// Checks each robot alone, and then all of them together.
class FleetCheck {
 public:
  FleetCheck(const CheckedFleet& fleet, const std::vector<RobotPlan>& plans, const CheckRules& rules,
             const StopCondition& stop)
      : checked_(fleet), rules_(rules), stop_(stop), plan_of_(plans_by_robot(fleet.robots.size(), plans)) {}

  std::optional<VerifyReport> run() {
    const ObstacleField field(checked_.grid);
    for (std::size_t index = 0; index < checked_.robots.size(); ++index) {
      if (stop_.met()) return std::nullopt;
      check_alone(index, field);
    }
    std::optional<PairReport> pairs = PairCheck(fleet_, checked_.obstacles, rules_, stop_).run();
    if (!pairs || stop_.met()) return std::nullopt;
    violations_.add(std::move(pairs->violations));
    const std::size_t count = violations_.total();
    return VerifyReport{violations_.take(), count, pairs->min_clearance};
  }

 private:
  void check_alone(std::size_t index, const ObstacleField& field) {
    const RobotPlan* plan = plan_of_[index];
    if (const auto unusable = find_unusable_number(index, checked_.robots[index], plan)) {
      violations_.add(*unusable);
      return;
    }
    const Tolerance& tolerance = rules_.tolerances[index];
    const ZonesOfRobot zones(checked_.zones, index);
    if (const auto less = without_goals_put_off(checked_.robots[index], plan, zones, tolerance)) {
      check_alone(index, less->robot, plan != nullptr ? &less->plan : nullptr, field, zones);
    } else {
      check_alone(index, checked_.robots[index], plan, field, zones);
    }
  }

  /// A robot with goals that are put off, see Zone::may_leave. It visits the goals before them and may rest
  /// where its plan ends.
  struct PutOff {
    Robot robot;
    RobotPlan plan;
  };

  /// Whether a plan is to visit this goal of the robot: by its list of visits. Without a list, if it ends at
  /// the last goal.
  static bool serves(const Robot& robot, const RobotPlan& plan, std::size_t goal,
                     const Tolerance& tolerance) {
    if (!plan.visits.empty()) return goal < plan.visits.size();
    const Pose& end = plan.actions.empty() ? robot.start : plan.actions.back().to;
    const Goal& last = robot.goal_at(robot.own_goal_count() - 1);
    const double metres = std::max(tolerance.metres, kContactTolerance);
    return (end.position - last.position).norm() <= metres &&
           (!last.theta || angle_between(end.theta, *last.theta) <= tolerance.radians);
  }

  std::optional<PutOff> without_goals_put_off(const Robot& robot, const RobotPlan* plan,
                                              const ZonesOfRobot& zones, const Tolerance& tolerance) const {
    if (!zones.may_leave_any()) return std::nullopt;
    const std::size_t first = goals_served_by_commitment(robot, tolerance, stop_);
    const double margin = std::max(tolerance.metres, kContactTolerance);
    const auto visits = [&](std::size_t goal) {
      return plan != nullptr && serves(robot, *plan, goal, tolerance);
    };
    const auto put_off = zones.first_goal_put_off(robot, first, margin, visits);
    if (!put_off) return std::nullopt;
    PutOff less{robot, plan != nullptr ? *plan : RobotPlan{}};
    less.robot.via.resize(*put_off);
    const bool moves = less.plan.actions.size() > robot.committed.size();
    const bool stays = *put_off == 0 && !moves && !robot.yields();  // as if it had no goal
    const Pose end = less.plan.actions.empty() ? robot.committed_end() : less.plan.actions.back().to;
    less.robot.goal = stays ? std::nullopt : std::optional(Goal{end.position, std::nullopt});
    less.plan.visits.resize(std::min(less.plan.visits.size(), *put_off));
    const bool visits_all_before = *put_off > 0 && less.plan.visits.size() == *put_off;
    if (visits_all_before) less.plan.visits.push_back({*put_off, plan->cost, kForever});
    return less;
  }

  void check_alone(std::size_t index, const Robot& robot, const RobotPlan* plan, const ObstacleField& field,
                   const ZonesOfRobot& zones) {
    const Tolerance& tolerance = rules_.tolerances[index];
    const CarriedLoads loads(robot, plan, tolerance);
    if (plan != nullptr) check_plan(robot, *plan, loads, tolerance);
    const Handover handover = handover_of(robot, plan);
    std::vector<Leg> legs;
    std::vector<double> radii;  // by leg
    for (SizedLegs& body : sized_legs_of(loads, execute(robot, plan, loads))) {
      legs.insert(legs.end(), body.legs.begin(), body.legs.end());
      radii.resize(legs.size(), body.radius);
      add_to_fleet(robot, plan, std::move(body), handover, index);
    }
    if (robot.invalid) return;  // it may stand in a wall
    const auto distance_from = [&](const Position& position, double reach) {
      return zones.distance_to_blocked(position, distance_from_walls(field, position, reach));
    };
    const bool ends_in_goal = plan != nullptr && stays_at_last_goal(checked_.robots[index], legs, tolerance);
    const std::vector<double> kept =
        distances_to_keep(distance_from, radii, legs, handover, ends_in_goal, tolerance.metres, rules_);
    violations_.add(check_obstacles(field, index, kept, legs, tolerance.metres, stop_));
    if (zones.empty()) return;
    violations_.add(zones.check_blocked(kept, radii, legs, handover, tolerance.metres, stop_));
    violations_.add(
        zones.check_driving(plan != nullptr ? plan->actions : robot.committed, loads, tolerance, stop_));
  }

  /// Whether the robot ends where it is to stay for good.
  static bool stays_at_last_goal(const Robot& robot, const std::vector<Leg>& legs,
                                 const Tolerance& tolerance) {
    if (!robot.goal || robot.yields()) return false;
    const double metres = std::max(tolerance.metres, kContactTolerance);
    return (legs.back().to - robot.goal->position).norm() <= metres;
  }

  void add_to_fleet(const Robot& robot, const RobotPlan* plan, SizedLegs body, const Handover& handover,
                    std::size_t index) {
    fleet_.robots.push_back(index);
    fleet_.radii.push_back(body.radius);
    fleet_.vicinities.push_back(robot.vicinity);
    fleet_.tolerances.push_back(rules_.tolerances[index].metres);
    fleet_.legs.push_back(std::move(body.legs));
    fleet_.handovers.push_back(handover);
    fleet_.invalid.push_back(robot.invalid);
    fleet_.stays.push_back(plan == nullptr || !robot.goal);
  }

  void check_plan(const Robot& robot, const RobotPlan& plan, const CarriedLoads& loads,
                  const Tolerance& tolerance) {
    const auto changed = check_commitments(robot, plan, tolerance, rules_.exact_commitments);
    if (changed) violations_.add(*changed);
    // Committed actions that exactly repeat the request's actions are not judged.
    const std::size_t given = rules_.exact_commitments && !changed ? robot.committed.size() : 0;
    violations_.add(check_motion(robot, plan, given, loads, tolerance, stop_));
    const GoalsLeft goals_left =
        may_leave_goals(robot, plan, tolerance) ? GoalsLeft::allowed : GoalsLeft::none;
    for (Violation& wrong : check_terminals(robot, plan, tolerance, goals_left))
      violations_.add(std::move(wrong));
    for (Violation& wrong : check_visits(robot, plan, tolerance, goals_left, stop_))
      violations_.add(std::move(wrong));
    violations_.add(check_waits(robot, plan, rules_.wait_before_move, tolerance, stop_));
  }

  bool may_leave_goals(const Robot& robot, const RobotPlan& plan, const Tolerance& tolerance) const {
    return rules_.horizon && robot.goal && !plan.actions.empty() &&
           plan.actions.back().t_end >= *rules_.horizon - tolerance.seconds;
  }

  const CheckedFleet& checked_;
  const CheckRules& rules_;
  const StopCondition& stop_;
  std::vector<const RobotPlan*> plan_of_;
  ExecutedFleet fleet_;  // the robots whose numbers are usable
  ViolationList violations_;
};

}  // namespace

std::optional<VerifyReport> verify(const CheckedFleet& fleet, const std::vector<RobotPlan>& plans,
                                   const CheckRules& rules, const StopCondition& stop) {
  return FleetCheck(fleet, plans, rules, stop).run();
}

std::optional<VerifyReport> check_plan(const Problem& problem, const PlanOptions& options, const Plan& plan,
                                       const StopCondition& stop) {
  CheckRules rules{plan_tolerances(problem.grid(), problem.robots(), plan.plans)};
  rules.interval_margin = options.interval_margin;
  rules.start_overlap = options.start_overlap;
  rules.goal_overlap = options.goal_overlap;
  rules.horizon = options.horizon;
  rules.exact_commitments = true;
  rules.exempt = plan.unavoidable;
  return verify({problem.grid(), problem.robots(), problem.obstacles(), &problem.zones()}, plan.plans, rules,
                stop);
}

}  // namespace fleetplan::core
