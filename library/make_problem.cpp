#include <fleetplan/limits.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <variant>

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/speed_profile.h"
#include "core/geometry/tolerance.h"
#include "core/map/lattice.h"
#include "core/map/static_map.h"
#include "core/model/loads.h"
#include "core/model/open_goal.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/goal_choice.h"
#include "library/convert.h"

namespace fleetplan::library {

namespace {

/// An inclusive range of numbers.
struct Range {
  double least;
  double max;
  const char* unit;

  bool contains(double value) const { return value >= least && value <= max; }
};

constexpr Range kLength{kShortestLength, kLargestExtent, " m"};
constexpr Range kLengthOrZero{0.0, kLargestExtent, " m"};
constexpr Range kCoordinate{-kFarthestCoordinate, kFarthestCoordinate, " m"};
constexpr Range kLinearSpeed{kLeastLinearSpeed, kMaxLinearSpeed, " m/s"};
constexpr Range kAngularSpeed{kLeastAngularSpeed, kMaxAngularSpeed, " rad/s"};
constexpr Range kAcceleration{kLeastAcceleration, kMaxAcceleration, " per second squared"};
constexpr Range kProfileSpeed{0.0, kMaxAngularSpeed, ""};
constexpr Range kDuration{0.0, kLongestTime, " s"};
constexpr Range kGoalTolerance{0.0, core::kMaxGoalTolerance, " m"};
constexpr Range kAngle{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(), " rad"};

/// Returns the shortest text of a number.
std::string number_text(double number) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, result.ptr};
}

/// Returns the place of an item of a list: "robots[3]".
std::string item(const std::string& list, std::size_t index) {
  return list + '[' + std::to_string(index) + ']';
}

constexpr std::size_t kMaxFaults = 20;

/// Collects faults. If there are many, keeps only the first ones.
class FaultList {
 public:
  explicit FaultList(std::size_t max) : max_(max) {}

  void add(std::string place, std::string detail) {
    if (listed_.size() < max_) listed_.push_back({std::move(place), std::move(detail)});
  }
  void check(double value, const Range& range, const std::string& place) {
    if (range.contains(value)) return;
    add(place, "The value is " + number_text(value) + "; it must be from " + number_text(range.least) +
                   " to " + number_text(range.max) + range.unit + '.');
  }
  bool empty() const { return listed_.empty(); }
  std::vector<Fault> take() { return std::move(listed_); }

 private:
  std::size_t max_;
  std::vector<Fault> listed_;
};

using Type = core::Action::Type;

constexpr double kTolerance = core::kContactTolerance;
/// Radians and seconds by which actions may deviate, as in the service (api/request/fleet/parse_actions.cpp).
constexpr double kTurnTolerance = core::kSamePosition;
constexpr double kTimeRounding = std::numeric_limits<double>::epsilon() * core::kLongestPlan;

double distance(const core::Pose& a, const core::Pose& b) { return (b.position - a.position).norm(); }
double turn(const core::Pose& a, const core::Pose& b) { return core::angle_between(a.theta, b.theta); }

bool in_range(const Action& action) {
  const auto is_pose = [](const Pose& pose) {
    return kCoordinate.contains(pose.x) && kCoordinate.contains(pose.y) && kAngle.contains(pose.theta);
  };
  return kDuration.contains(action.t_start) && kDuration.contains(action.t_end) && is_pose(action.from) &&
         is_pose(action.to) &&
         (!action.profile ||
          (kProfileSpeed.contains(action.profile->start) && kProfileSpeed.contains(action.profile->cruise) &&
           kProfileSpeed.contains(action.profile->end)));
}

/// Returns why an action cannot follow a pose and a time; null if it can.
const char* gap(const core::Action& action, const core::Pose& before, double now) {
  if (std::abs(action.t_start - now) > kTolerance) return "does not start when the one before ends";
  if (action.t_end < action.t_start - kTolerance) return "ends before it starts";
  if (distance(before, action.from) > kTolerance || turn(before, action.from) > kTolerance) {
    return "does not begin where the one before ends, or at the robot's start";
  }
  const bool moves = action.type != Type::translate && distance(action.from, action.to) > kTolerance;
  const bool turns = action.type != Type::rotate && turn(action.from, action.to) > kTolerance;
  return moves || turns ? "contradicts its type: only translations move, and only rotations turn" : nullptr;
}

/// Returns why a robot cannot execute an action; null if it can.
const char* impossible(const core::Action& action, const core::Robot& robot, const core::Load& load) {
  const double duration = action.t_end - action.t_start;
  if (action.type == Type::rotate) {
    const double tolerance = kTurnTolerance + robot.angular_speed * kTimeRounding;
    const bool is_fast = turn(action.from, action.to) > robot.angular_speed * duration + tolerance;
    return is_fast ? "is faster than the robot" : nullptr;
  }
  if (action.type != Type::translate) return nullptr;
  const double length = distance(action.from, action.to);
  if (length > load.linear_speed * duration + kTolerance || (duration <= 0.0 && length > 0.0)) {
    return "is faster than the robot";
  }
  const core::Position d = action.to.position - action.from.position;
  const core::Position heading = core::unit_vector(action.from.theta);
  if (std::abs(core::cross_product(heading, d)) > kTolerance) return "leads off the line of its heading";
  if (!action.reverse) return nullptr;
  if (!robot.may_reverse) return "reverses, but the robot may not";
  return d.dot(heading) > kTolerance ? "leads ahead, although it reverses" : nullptr;
}

/// Returns why the profile of an action does not fit; null if it does. Only measured motion has no profile.
/// `speed`: at the end of the action before; none: unknown.
const char* unfit(const core::Action& action, const core::Robot& robot, const core::Load& load,
                  std::optional<double> speed, bool may_be_measured) {
  if (!action.profile) {
    const bool has_to = !may_be_measured && robot.limits_changes_of_speed(action.type) &&
                        core::amount_of(action) > kTolerance;
    if (has_to) return "has no profile, but the robot's acceleration is limited";
    const bool is_measured = action.type == Type::translate;
    return speed.value_or(0.0) > kTolerance && !is_measured ? "begins at rest, unlike the one before ends"
                                                            : nullptr;
  }
  const core::SpeedProfile& profile = *action.profile;
  if (action.type == Type::wait) return "has a profile, but waits";
  if (!profile.is_possible()) {
    return "has a profile whose cruise speed is 0, or less than start or end";
  }
  const double greatest = action.type == Type::rotate ? robot.angular_speed : load.linear_speed;
  if (profile.cruise > greatest + kTolerance) {
    return "has a profile that is faster than the robot";
  }
  if (speed && std::abs(profile.start - *speed) > kTolerance) {
    return "has a profile that does not begin at the speed at which the one before ends";
  }
  return core::profile_fits(action) ? nullptr
                                    : "has a profile that does not lead over its length in its time";
}

/// Reads the committed or previous actions of a robot. Differences within the contact tolerance are removed,
/// so that the actions are exactly contiguous. Larger differences, and actions that the robot cannot execute,
/// are faults. The first `measured` actions may be measured motion, which has no profiles.
std::vector<core::Action> read_actions(const std::vector<Action>& actions, const core::Robot& robot,
                                       const std::vector<core::OpenGoal>& open, std::size_t measured,
                                       const Frame& frame, const std::string& place, FaultList& faults) {
  std::vector<core::Action> read;
  read.reserve(actions.size());
  core::Pose before = robot.start;
  double now = 0.0;
  std::optional<double> speed;
  core::OpenLoadOnTheWay on_the_way(robot, open);
  for (std::size_t k = 0; k < actions.size(); ++k) {
    const auto refuse = [&](const std::string& why) {
      faults.add(item(place, k), "The action " + why + '.');
      return read;
    };
    if (!in_range(actions[k])) return refuse("has a time, a coordinate or a speed out of range");
    if (actions[k].goal && actions[k].type != Action::Type::wait)
      return refuse("names a goal, but does not wait");
    if (actions[k].goal && *actions[k].goal >= robot.goal_count())
      return refuse("names a goal that there is not");
    core::Action action = frame.to_core(actions[k]);
    if (const char* why = gap(action, before, now)) return refuse(why);
    action.t_start = now;
    action.t_end = std::max(action.t_start, action.t_end);
    action.from = before;
    if (action.type != Type::translate) action.to.position = action.from.position;
    if (action.type != Type::rotate) action.to.theta = action.from.theta;
    const core::Load& load = on_the_way.load();
    if (const char* why = impossible(action, robot, load)) return refuse(why);
    core::set_inertia(action, robot, load);
    if (const char* why = unfit(action, robot, load, speed, k < measured)) return refuse(why);
    on_the_way.execute(action);
    speed.reset();
    if (action.profile || action.type != Type::translate) speed = action.profile ? action.profile->end : 0.0;
    before = action.to;
    now = action.t_end;
    read.push_back(action);
  }
  if (speed.value_or(0.0) > kTolerance) {
    faults.add(item(place, read.size() - 1), "The action ends at a speed; the last one has to end at rest.");
  }
  return read;
}

constexpr Range kHalfAngle{kLeastHalfAngle, std::numbers::pi, " rad"};
constexpr Range kDue{-kLongestTime, kLongestTime, " s"};
constexpr Range kWeight{kLeastWeight, kMaxWeight, ""};
constexpr Range kHorizon{kShortestHorizon, kLongestTime, " s"};

void check_position(double x, double y, const std::string& place, FaultList& faults) {
  faults.check(x, kCoordinate, place + ".x");
  faults.check(y, kCoordinate, place + ".y");
}

void check_any_of(const Goal& goal, const std::string& place, FaultList& faults) {
  const std::string list = place + ".any_of";
  const std::size_t count = goal.any_of.size();
  if (goal.choice && *goal.choice >= count) {
    faults.add(place + ".choice", count == 0 ? "The goal has no any_of."
                                             : "any_of has no pose of this number; the first one is 0.");
  }
  if (count > 0 && (count < kFewestPoses || count > kMaxPoses)) {
    faults.add(list, "There are " + std::to_string(count) + " poses; there must be " +
                         std::to_string(kFewestPoses) + " to " + std::to_string(kMaxPoses) + '.');
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Alternative& pose = goal.any_of[k];
    check_position(pose.x, pose.y, item(list, k), faults);
    if (pose.theta) faults.check(*pose.theta, kAngle, item(list, k) + ".theta");
    faults.check(pose.bias, kDuration, item(list, k) + ".bias");
  }
}

void check_tolerance(const Goal& goal, const std::string& place, FaultList& faults) {
  faults.check(goal.tolerance, kGoalTolerance, place + ".tolerance");
  if (goal.tolerance > 0.0 && !goal.any_of.empty()) {
    faults.add(place + ".tolerance", "The goal has any_of, whose poses are all that it may be served at.");
  }
  if (!goal.place) return;
  check_position(goal.place->x, goal.place->y, place + ".place", faults);
  const core::Position away(goal.place->x - goal.x, goal.place->y - goal.y);
  if (!(away.norm() <= goal.tolerance + core::kContactTolerance)) {
    faults.add(place + ".place", "The place is farther from the goal than its tolerance.");
  }
}

void check_goal(const Goal& goal, const std::string& place, FaultList& faults) {
  check_position(goal.x, goal.y, place, faults);
  if (goal.theta) faults.check(*goal.theta, kAngle, place + ".theta");
  check_any_of(goal, place, faults);
  check_tolerance(goal, place, faults);
  faults.check(goal.service, kDuration, place + ".service");
  faults.check(goal.not_before, kDuration, place + ".not_before");
  const auto check = [&](const std::optional<double>& number, const Range& range, const char* name) {
    if (number) faults.check(*number, range, place + name);
  };
  check(goal.radius_after, kLength, ".radius_after");
  check(goal.linear_speed_after, kLinearSpeed, ".linear_speed_after");
  check(goal.linear_acceleration_after, kAcceleration, ".linear_acceleration_after");
  check(goal.linear_deceleration_after, kAcceleration, ".linear_deceleration_after");
  if (!goal.due) return;
  faults.check(*goal.due, kDue, place + ".due");
  if (goal.not_before > 0.0 && *goal.due < goal.not_before) {
    faults.add(place + ".due", "The goal is due before its not_before.");
  }
}

void check_robot(const Robot& robot, const std::string& place, FaultList& faults) {
  faults.check(robot.radius, kLength, place + ".radius");
  faults.check(robot.linear_speed, kLinearSpeed, place + ".linear_speed");
  faults.check(robot.angular_speed, kAngularSpeed, place + ".angular_speed");
  faults.check(robot.vicinity, kLengthOrZero, place + ".vicinity");
  faults.check(robot.goal_age, kDuration, place + ".goal_age");
  faults.check(robot.weight, kWeight, place + ".weight");
  const auto check_limit = [&](const std::optional<double>& limit, const char* name) {
    if (limit) faults.check(*limit, kAcceleration, place + name);
  };
  check_limit(robot.linear_acceleration, ".linear_acceleration");
  check_limit(robot.linear_deceleration, ".linear_deceleration");
  check_limit(robot.angular_acceleration, ".angular_acceleration");
  check_position(robot.start.x, robot.start.y, place + ".start", faults);
  faults.check(robot.start.theta, kAngle, place + ".start.theta");
  const bool is_limited = robot.linear_acceleration || robot.linear_deceleration;
  for (std::size_t k = 0; k < robot.goals.size(); ++k) {
    const std::string here = item(place + ".goals", k);
    check_goal(robot.goals[k], here, faults);
    if (is_limited || !(robot.goals[k].linear_acceleration_after || robot.goals[k].linear_deceleration_after))
      continue;
    faults.add(here, "A load changes the acceleration of a robot that has no linear_acceleration.");
  }
}

void check_obstacle(const MovingObstacle& obstacle, const std::string& place, FaultList& faults) {
  faults.check(obstacle.radius, kLength, place + ".radius");
  if (obstacle.motion.empty())
    faults.add(place + ".motion", "The motion has no entry; it needs one at least.");
  for (std::size_t k = 0; k < obstacle.motion.size(); ++k) {
    const MovingObstacle::Entry& entry = obstacle.motion[k];
    const std::string here = item(place + ".motion", k);
    faults.check(entry.t, kDuration, here + ".t");
    check_position(entry.position.x, entry.position.y, here + ".position", faults);
    if (k == 0) continue;
    const MovingObstacle::Entry& before = obstacle.motion[k - 1];
    const double duration = entry.t - before.t;
    const double distance =
        core::Position(entry.position.x - before.position.x, entry.position.y - before.position.y).norm();
    if (duration <= 0.0) faults.add(here + ".t", "The entry is not later than the one before.");
    if (duration > 0.0 && distance > kMaxLinearSpeed * duration) {
      faults.add(here, "The obstacle moves faster than " + number_text(kMaxLinearSpeed) + " m/s.");
    }
  }
}

void check_zone(const Zone& zone, std::size_t robots, const std::string& place, FaultList& faults) {
  constexpr std::size_t kFewestCorners = 3;
  if (zone.polygon.size() < kFewestCorners)
    faults.add(place + ".polygon", "A polygon has at least 3 corners.");
  for (std::size_t k = 0; k < zone.polygon.size(); ++k) {
    const std::string here = item(place + ".polygon", k);
    check_position(zone.polygon[k].x, zone.polygon[k].y, here, faults);
    if (zone.polygon[k] == zone.polygon[k == 0 ? zone.polygon.size() - 1 : k - 1]) {
      faults.add(here, "The corner equals the one before; the first one follows the last one.");
    }
  }
  if (zone.linear_speed) faults.check(*zone.linear_speed, kLinearSpeed, place + ".linear_speed");
  if (zone.angular_speed) faults.check(*zone.angular_speed, kAngularSpeed, place + ".angular_speed");
  faults.check(zone.heading, kAngle, place + ".heading");
  if (zone.type == Zone::Type::one_way) faults.check(zone.half_angle, kHalfAngle, place + ".half_angle");
  for (std::size_t k = 0; k < zone.robots.size(); ++k) {
    if (zone.robots[k] >= robots) faults.add(item(place + ".robots", k), "There is no such robot.");
  }
}

/// Returns a fault of the geometry in the words of the library.
Fault described(const core::ProblemFault& found) {
  using Kind = core::ProblemFault::Kind;
  const std::string robot = item("robots", found.robot);
  const std::string overlap = number_text(-found.gap) + " m";
  const std::string obstacle =
      found.zone ? "the blocked " + item("zones", *found.zone) : "a blocked cell or the edge of the map";
  const std::string disk = "The disk of radius " + number_text(found.radius) + " m overlaps ";
  switch (found.kind) {
    case Kind::start_in_obstacle:
      return {robot + ".start", disk + obstacle + " by " + overlap + '.'};
    case Kind::goal_in_obstacle:
      return {item(robot + ".goals", found.goal), disk + obstacle + " by " + overlap + '.'};
    case Kind::starts_overlap:
      return {robot + ".start",
              "It overlaps the start of " + item("robots", found.other) + " by " + overlap + '.'};
    case Kind::goals_overlap:
      return {robot + ".goals",
              "The last goal overlaps that of " + item("robots", found.other) + " by " + overlap + '.'};
    case Kind::committed_in_zone:
      return {robot + ".committed", "The motion breaks the rule of " + item("zones", *found.zone) + " at " +
                                        number_text(found.t) + " s."};
    case Kind::committed_collision:
      break;
  }
  const std::string other = found.other == found.robot ? obstacle : item("robots", found.other);
  return {robot + ".committed",
          "The motion meets " + other + " at " + number_text(found.t) + " s: an overlap of " + overlap + '.'};
}

std::vector<Fault> faults_of(const Options& options, const Map& map) {
  FaultList faults(kMaxFaults);
  if (options.time_budget.count() <= 0)
    faults.add("options.time_budget", "The time budget must be positive.");
  const auto interval = options.start_safe_interval.value_or(0.0);
  faults.check(interval, kDuration, "options.start_safe_interval");
  faults.check(options.inflation, kLengthOrZero, "options.inflation");
  faults.check(options.wait_before_move, kDuration, "options.wait_before_move");
  faults.check(options.interval_margin, kDuration, "options.interval_margin");
  faults.check(options.start_overlap, kLengthOrZero, "options.start_overlap");
  faults.check(options.goal_overlap, kLengthOrZero, "options.goal_overlap");
  if (options.horizon) faults.check(*options.horizon, kHorizon, "options.horizon");
  const int c = options.connectivity;
  if (c != 4 && c != 8 && c != 16 && c != 32) {
    faults.add("options.connectivity", "The connectivity must be 4, 8, 16 or 32.");
  }
  if (options.max_iterations && *options.max_iterations < 0) {
    faults.add("options.max_iterations", "The number of steps must not be negative.");
  }
  if (!options.lattice_spacing) return faults.take();
  faults.check(*options.lattice_spacing, kLength, "options.lattice_spacing");
  if (!faults.empty()) return faults.take();
  constexpr std::int64_t kMaxVertices = 1'000'000'000;
  const auto along = [&](int cells) {
    return core::Lattice::vertices_along(cells * map.resolution(), *options.lattice_spacing);
  };
  const std::int64_t columns = along(map.columns());
  const std::int64_t rows = along(map.rows());
  if (columns < 1 || rows < 1 || columns > kMaxVertices / rows) {
    faults.add("options.lattice_spacing", "The lattice has no vertex on this map, or more than 1e9.");
  }
  return faults.take();
}

bool has_open_goals(const core::OpenGoals& open) {
  return std::any_of(open.begin(), open.end(), [](const auto& goals) { return !goals.empty(); });
}

}  // namespace

bool in_motion(const Problem& problem) {
  return std::any_of(problem.robots.begin(), problem.robots.end(),
                     [](const Robot& robot) { return !robot.committed.empty() || robot.previous; });
}

ReadFleet read_fleet(const Problem& problem) {
  const Frame frame(problem.map);
  FaultList faults(kMaxFaults);
  ReadFleet read;
  for (std::size_t k = 0; k < problem.robots.size(); ++k) {
    const Robot& robot = problem.robots[k];
    const std::string place = item("robots", k);
    check_robot(robot, place, faults);
    core::Robot& made = read.robots.emplace_back(robot_of(robot, frame));
    const std::vector<core::OpenGoal>& open = read.open.emplace_back(open_goals_of(robot, frame));
    const std::size_t measured = robot.committed.size();
    made.committed = read_actions(robot.committed, made, open, measured, frame, place + ".committed", faults);
    if (robot.previous) {
      made.previous = read_actions(*robot.previous, made, open, measured, frame, place + ".previous", faults);
    }
    if (robot.idle == Robot::Idle::yield) made.let_yield();
    if (robot.idle == Robot::Idle::come_back && !made.goal) {
      made.goal = core::Goal{made.committed_end().position, made.committed_end().theta};
    }
  }
  for (std::size_t k = 0; k < problem.obstacles.size(); ++k) {
    check_obstacle(problem.obstacles[k], item("obstacles", k), faults);
    read.obstacles.push_back(obstacle_of(problem.obstacles[k], frame));
  }
  for (std::size_t k = 0; k < problem.zones.size(); ++k) {
    check_zone(problem.zones[k], problem.robots.size(), item("zones", k), faults);
    read.zones.push_back(zone_of(problem.zones[k], frame));
  }
  read.faults = faults.take();
  return read;
}

namespace {

/// Returns the fault of a goal for which there is no pose.
Fault described(const core::WithoutPose& goal, const core::OpenGoals& open) {
  const auto& [robot, index] = goal.place;
  return {item(item("robots", robot) + ".goals", open[robot][index].goal) + ".any_of",
          goal.any_fits ? "The robot would stay at one of these poses, but others stay at all that fit."
                        : "None of these poses fits: at each of them, the disk of the robot overlaps an "
                          "obstacle or the edge of the map."};
}

bool is_of_a_pair(const core::ProblemFault& found) {
  using Kind = core::ProblemFault::Kind;
  return found.kind != Kind::start_in_obstacle && found.kind != Kind::goal_in_obstacle &&
         found.other != found.robot;
}

/// Makes the problem. If necessary, makes it again, each time with more robots that are invalid.
class ProblemMaker {
 public:
  ProblemMaker(const std::shared_ptr<const core::StaticMap>& map, ReadFleet fleet,
               const core::PlanOptions& options, bool reports, const core::StopCondition& stop)
      : map_(map), fleet_(std::move(fleet)), options_(options), reports_(reports), stop_(stop) {
    if (reports_) made_.invalid.resize(fleet_.robots.size());
  }

  MadeProblem run() {
    // Bounded: each time, another robot is invalid.
    while (!stop_.met()) {
      const bool any_open = has_open_goals(fleet_.open);
      if (any_open && !choose_poses()) {
        if (!made_.faults.empty()) break;
        continue;
      }
      auto created = core::Problem::create(map_, fleet_.robots, conditions(), stop_);
      if (auto* valid = std::get_if<core::Problem>(&created)) {
        std::optional<core::OpenFleet> open;
        if (any_open) open = core::OpenFleet{std::move(fleet_.robots), std::move(fleet_.open)};
        made_.task = core::PlanTask{std::move(*valid), options_, std::move(open)};
        break;
      }
      const auto& faults = std::get<core::ProblemFaults>(created);
      if (!faults.finished || (reports_ && mark_invalid(faults))) continue;
      for (const core::ProblemFault& found : faults.listed) made_.faults.push_back(described(found));
      break;
    }
    return std::move(made_);
  }

 private:
  /// Returns whether all open goals have a pose; otherwise there are faults, or robots are invalid.
  bool choose_poses() {
    const auto without =
        core::choose_without_search(map_, fleet_.zones, options_, fleet_.robots, fleet_.open, stop_);
    for (const core::WithoutPose& goal : without) {
      const Fault fault = described(goal, fleet_.open);
      if (reports_) {
        make_invalid(goal.place.robot, fault);
      } else {
        made_.faults.push_back(fault);
      }
    }
    return without.empty();
  }

  core::ProblemConditions conditions() const {
    core::ProblemConditions made = core::conditions_of(options_);
    made.obstacles = fleet_.obstacles;
    made.zones = fleet_.zones;
    made.list_faults_of_every_robot = reports_;
    return made;
  }

  /// Makes the robots at fault invalid. Returns false if all of them were invalid before.
  bool mark_invalid(const core::ProblemFaults& faults) {
    bool any = false;
    for (const core::ProblemFault& found : faults.listed) {
      const Fault fault = described(found);
      any = make_invalid(found.robot, fault) || any;
      if (is_of_a_pair(found)) any = make_invalid(found.other, fault) || any;
    }
    return any;
  }

  bool make_invalid(std::size_t index, const Fault& fault) {
    made_.invalid[index].push_back(fault);
    core::Robot& robot = fleet_.robots[index];
    if (robot.invalid) return false;
    robot.invalid = true;
    robot.goal.reset();
    robot.via.clear();
    robot.committed.clear();
    robot.previous.reset();
    return true;
  }

  const std::shared_ptr<const core::StaticMap>& map_;
  ReadFleet fleet_;
  const core::PlanOptions& options_;
  const bool reports_;
  const core::StopCondition& stop_;
  MadeProblem made_;
};

}  // namespace

MadeProblem make_problem(const Problem& problem, const Options& options, const std::stop_token& stop) {
  ReadFleet fleet = read_fleet(problem);
  MadeProblem made;
  made.faults = std::move(fleet.faults);
  for (Fault& fault : faults_of(options, problem.map)) made.faults.push_back(std::move(fault));
  if (!made.faults.empty()) return made;
  const core::StopCondition cancelled(core::StopCondition::Clock::time_point::max(), stop);
  const auto map = core::static_map(grid_of(problem.map), cancelled);
  if (!map) return made;
  const bool reports = options.invalid_robots == Options::InvalidRobots::report;
  const core::PlanOptions core_options = options_of(options, in_motion(problem));
  return ProblemMaker(map, std::move(fleet), core_options, reports, cancelled).run();
}

}  // namespace fleetplan::library

namespace fleetplan {

std::vector<Fault> faults_of(const Problem& problem, const Options& options) {
  return library::make_problem(problem, options, {}).faults;
}

InvalidProblem::InvalidProblem(std::vector<Fault> faults)
    : std::invalid_argument(faults.empty() ? "the problem is not valid"
                                           : faults.front().place + ": " + faults.front().detail),
      faults_(std::move(faults)) {}

}  // namespace fleetplan
