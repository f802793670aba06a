#include "api/request/fleet/parse_actions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "api/request/limits.h"
#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"
#include "core/geometry/tolerance.h"

namespace fleetplan::api {

namespace {

constexpr double kTolerance = core::kContactTolerance;
/// The most by which a rotation may deviate, radians. Rotations are not drawn to a vertex, and the check of
/// the answer allows no more.
constexpr double kTurnTolerance = core::kSamePosition;
/// What doubles lose in the times of the longest plan, seconds. A fast robot turns visibly in that time. The
/// times of an action may have been as late as that, before /v1/advance made them earlier.
constexpr double kTimeRounding = std::numeric_limits<double>::epsilon() * core::kLongestPlan;

double distance_between(const core::Pose& a, const core::Pose& b) { return (b.position - a.position).norm(); }

double turn_between(const core::Pose& a, const core::Pose& b) {
  return core::angle_between(a.theta, b.theta);
}

/// Returns how far a translation leads off the line of its heading, metres. A robot may drive backwards.
double sideways(const core::Action& action) {
  const core::Position d = action.to.position - action.from.position;
  return std::abs(core::cross_product(core::unit_vector(action.from.theta), d));
}

/// Returns how far a translation leads along its heading, metres.
double ahead(const core::Action& action) {
  const core::Position d = action.to.position - action.from.position;
  return core::unit_vector(action.from.theta).dot(d);
}

std::string seconds(double t) { return number_text(t) + " s"; }

}  // namespace

ActionChain::ActionChain(const ActionsOwner& owner)
    : robot_(owner.robot),
      linear_speed_(owner.linear_speed),
      angular_speed_(owner.angular_speed),
      may_reverse_(owner.may_reverse),
      measured_(owner.measured),
      pose_(owner.start) {
  if (!core::changes_load(owner.robot)) return;
  loads_.emplace(owner.robot, owner.open != nullptr ? *owner.open : std::vector<core::OpenGoal>());
}

std::string ActionChain::name() const { return "Action " + std::to_string(count_) + " (from 0)"; }

core::Action ActionChain::append(core::Action action, const JsonReader& item) {
  const std::size_t before = item.fault_count();
  check_times(action, item);
  check_begin(action, item);
  check_type(action, item);
  if (item.fault_count() == before) {
    const double given = sideways(action);  // as an answer repeats it
    action = joined(action);
    check_speed(action, item);
    check_direction(action, std::max(given, sideways(action)), item);
    core::set_inertia(action, robot_, load());
    if (action.profile) check_profile(action, item);
    check_has_profile(action, item);
    check_speeds_meet(action, item);
    if (action.reverse) check_reverse(action, item);
  }
  if (loads_) loads_->execute(action);
  now_ = action.t_end;
  pose_ = action.to;
  const bool measured = action.type == core::Action::Type::translate && !action.profile;
  speed_ = measured ? std::nullopt : std::optional(action.profile ? action.profile->end : 0.0);
  ++count_;
  return action;
}

void ActionChain::skip() {
  now_.reset();
  pose_.reset();
  speed_.reset();
  ++count_;
}

void ActionChain::check_times(const core::Action& action, const JsonReader& item) const {
  if (now_ && std::abs(action.t_start - *now_) > kTolerance) {
    item.find("t_start").fault(fault::kDiscontinuity, [&] {
      return name() + " starts at " + seconds(action.t_start) + ", but " +
             (count_ == 0 ? "the first one must start at 0 s"
                          : "the action before ends at " + seconds(*now_)) +
             "; actions must be contiguous in time.";
    });
  }
  if (action.t_end < action.t_start - kTolerance) {
    item.find("t_end").fault(fault::kDiscontinuity, [&] {
      return name() + " ends at " + seconds(action.t_end) + ", before it starts at " +
             seconds(action.t_start) + "; t_end must be at least t_start.";
    });
  }
}

void ActionChain::check_begin(const core::Action& action, const JsonReader& item) const {
  if (!pose_) return;
  const double jump = distance_between(*pose_, action.from);
  const double turn = turn_between(*pose_, action.from);
  if (jump <= kTolerance && turn <= kTolerance) return;
  item.find("from").fault(fault::kDiscontinuity, [&] {
    return name() + " begins " + (jump > kTolerance ? number_text(jump) + " m" : number_text(turn) + " rad") +
           " off " + (count_ == 0 ? "the robot's start" : "where the action before ends") +
           "; actions must be contiguous in space, from the start on.";
  });
}

void ActionChain::check_type(const core::Action& action, const JsonReader& item) const {
  const double distance = distance_between(action.from, action.to);
  const double turn = turn_between(action.from, action.to);
  const bool moves = action.type != core::Action::Type::translate && distance > kTolerance;
  const bool turns = action.type != core::Action::Type::rotate && turn > kTolerance;
  if (!moves && !turns) return;
  item.find("to").fault(fault::kDiscontinuity, [&] {
    const bool waits = action.type == core::Action::Type::wait;
    const char* const does = waits ? " waits" : moves ? " rotates" : " translates";
    return name() + does + ", but " +
           (moves ? "moves by " + number_text(distance) + " m" : "turns by " + number_text(turn) + " rad") +
           "; use a " + (moves ? "translate" : "rotate") + " action for that.";
  });
}

std::optional<double> ActionChain::greatest_speed(const core::Action& action) const {
  if (action.type == core::Action::Type::rotate) return angular_speed_;
  return loads_ && linear_speed_ ? loads_->load().linear_speed : linear_speed_;
}

void ActionChain::check_speed(const core::Action& action, const JsonReader& item) const {
  const double duration = action.t_end - action.t_start;
  const bool translates = action.type == core::Action::Type::translate;
  const double amount = core::amount_of(action);
  const auto speed = greatest_speed(action);
  const char* const unit = translates ? "m" : "rad";
  const bool instant = translates && duration <= 0.0 && amount > 0.0;
  const double tolerance = translates ? kTolerance : kTurnTolerance + speed.value_or(0.0) * kTimeRounding;
  if (instant || (speed && amount > *speed * duration + tolerance)) {
    item.fault(fault::kSpeed, [&] {
      return name() + (translates ? " translates " : " rotates ") + number_text(amount) + " " + unit +
             " in " + seconds(duration) +
             (speed ? ", but the robot's speed is " + number_text(*speed) + " " + unit + "/s" : "") +
             "; give it more time.";
    });
  }
}

void ActionChain::check_direction(const core::Action& action, double off, const JsonReader& item) const {
  if (action.type != core::Action::Type::translate || off <= kTolerance) return;
  item.fault(fault::kSpeed, [&] {
    return name() + " moves " + number_text(off) +
           " m sideways; a translation must lead along the heading, forwards or backwards.";
  });
}

/// The profile has to cover the action, in its time.
void ActionChain::check_profile(const core::Action& action, const JsonReader& item) const {
  const core::SpeedProfile& profile = *action.profile;
  const bool turns = action.type == core::Action::Type::rotate;
  const JsonReader member = item.find("profile");
  const auto speed = greatest_speed(action);
  if (speed && profile.cruise > *speed + kTolerance) {
    member.fault(fault::kProfile, [&] {
      return name() + " has a profile with a cruise speed of " + number_text(profile.cruise) +
             ", but the robot's speed is " + number_text(*speed) + "; lower it.";
    });
    return;
  }
  if (core::profile_fits(action)) return;
  if (!profile.is_possible()) {
    member.fault(fault::kProfile, [&] {
      return name() + " has a profile with a cruise speed of " + number_text(profile.cruise) +
             "; it must be greater than 0, and no less than start and end.";
    });
    return;
  }
  const double amount = core::amount_of(action);
  const double duration = action.t_end - action.t_start;
  const double changes = profile.rise_time() + profile.fall_time();
  member.fault(fault::kProfile, [&] {
    return name() + (turns ? " rotates " : " translates ") + number_text(amount) + (turns ? " rad" : " m") +
           " in " + seconds(duration) + ", but with its profile and the robot's accelerations " +
           (duration < changes - kTolerance
                ? "changing speed alone takes " + seconds(changes)
                : "it would be " + number_text(core::covered_by_profile(action))) +
           "; give the speeds that belong to it, or leave the profile out for measured motion.";
  });
}

/// Only what is committed may be measured.
void ActionChain::check_has_profile(const core::Action& action, const JsonReader& item) const {
  if (action.profile || count_ < measured_) return;
  if (!robot_.limits_changes_of_speed(action.type) || core::amount_of(action) <= kTolerance) return;
  item.fault(fault::kProfile, [&] {
    return name() +
           " has no profile, but the robot's acceleration is limited; give the action as it was planned.";
  });
}

/// A robot with profiles does not change its speed at once.
void ActionChain::check_speeds_meet(const core::Action& action, const JsonReader& item) const {
  const bool measured = action.type == core::Action::Type::translate && !action.profile;
  if (!speed_ || measured) return;
  const double speed = action.profile ? action.profile->start : 0.0;
  if (std::abs(speed - *speed_) <= kTolerance) return;
  const JsonReader place = action.profile ? item.find("profile").find("start") : item;
  place.fault(fault::kProfile, [&] {
    return name() + " begins at a speed of " + number_text(speed) + ", but the action before ends at " +
           number_text(*speed_) + "; speeds of profiles must be contiguous.";
  });
}

void ActionChain::check_reverse(const core::Action& action, const JsonReader& item) const {
  if (may_reverse_ == false) {
    item.find("reverse").fault(fault::kSpeed, [&] {
      return name() + " reverses, but the robot may not; give the robot may_reverse.";
    });
  } else if (ahead(action) > kTolerance) {
    item.find("reverse").fault(fault::kSpeed, [&] {
      return name() + " leads " + number_text(ahead(action)) +
             " m ahead; with reverse it must lead backwards.";
    });
  }
}

/// Returns the action without the differences within the tolerance.
core::Action ActionChain::joined(core::Action action) const {
  if (now_) action.t_start = *now_;
  action.t_end = std::max(action.t_start, action.t_end);
  if (pose_) action.from = *pose_;
  if (action.type != core::Action::Type::translate) action.to.position = action.from.position;
  if (action.type != core::Action::Type::rotate) action.to.theta = action.from.theta;
  return action;
}

namespace {

// `for` of answers is ignored.
constexpr std::array<std::string_view, 9> kActionMembers{"type", "t_start", "t_end",   "from", "to",
                                                         "goal", "reverse", "profile", "for"};
constexpr std::array<std::string_view, 3> kProfileMembers{"start", "cruise", "end"};
constexpr std::array<std::string_view, 3> kPoseMembers{"x", "y", "theta"};
constexpr std::array<std::string_view, 3> kTypes{"rotate", "translate", "wait"};  // see core::Action::Type

core::Pose parse_pose(const JsonReader& member) {
  const JsonReader pose = member.object(kPoseMembers);
  const double x = pose.require("x").number(kCoordinate).value_or(0.0);
  const double y = pose.require("y").number(kCoordinate).value_or(0.0);
  return {{x, y}, pose.require("theta").number(kAnyAngle).value_or(0.0)};
}

/// Reads the profile of an action; none with a fault.
std::optional<core::SpeedProfile> parse_profile(const JsonReader& member) {
  const std::size_t before = member.fault_count();
  const JsonReader json = member.object(kProfileMembers);
  core::SpeedProfile profile;
  profile.start = json.require("start").number(kProfileSpeed).value_or(0.0);
  profile.cruise = json.require("cruise").number(kProfileSpeed).value_or(0.0);
  profile.end = json.require("end").number(kProfileSpeed).value_or(0.0);
  return member.fault_count() == before ? std::optional(profile) : std::nullopt;
}

bool gives_back(const core::Pose& map, const core::Pose& world, const WorldFrame& frame) {
  return frame.to_world(map.position) == world.position && map.theta == world.theta;
}

/// Whether the answer would contain the action as received.
bool gives_back(const core::Action& map, const core::Action& world, const WorldFrame& frame) {
  return map.t_start == world.t_start && map.t_end == world.t_end &&
         gives_back(map.from, world.from, frame) && gives_back(map.to, world.to, frame);
}

}  // namespace

core::Action parse_action(const JsonReader& item, const Range& times) {
  const JsonReader json = item.object(kActionMembers);
  core::Action action;
  const auto type = json.require("type").word(kTypes);
  if (type) action.type = static_cast<core::Action::Type>(*type);
  action.t_start = json.require("t_start").number(times).value_or(0.0);
  action.t_end = json.require("t_end").number(times).value_or(0.0);
  action.from = parse_pose(json.require("from"));
  action.to = parse_pose(json.require("to"));
  const JsonReader goal = json.find("goal");
  if (goal && type && action.type != core::Action::Type::wait) {
    goal.fault(fault::kUnknownKey, [] { return "goal is a member of wait actions only; remove it."; });
  } else if (const auto number = goal.natural(kGreatestIndex)) {
    action.goal = *number;
  }
  const JsonReader profile = json.find("profile");
  if (profile && type && action.type == core::Action::Type::wait) {
    profile.fault(fault::kUnknownKey, [] { return "A wait has no profile; remove it."; });
  } else if (profile) {
    action.profile = parse_profile(profile);
  }
  const JsonReader reverse = json.find("reverse");
  action.reverse = reverse.boolean().value_or(false);
  if (action.reverse && type && action.type != core::Action::Type::translate) {
    reverse.fault(fault::kUnknownKey, [] { return "reverse is for translate actions only; remove it."; });
  }
  return action;
}

core::Action to_map(const core::Action& world, const WorldFrame& frame) {
  core::Action action = world;
  for (core::Pose* pose : {&action.from, &action.to}) {
    *pose = {frame.to_map(pose->position), core::normalize_angle(pose->theta)};
  }
  return action;
}

std::optional<ParsedActions> parse_actions(const JsonReader& list, const ActionsOwner& owner,
                                           const WorldFrame& frame) {
  const JsonReader items = list.array();
  if (!items) return std::nullopt;
  const std::size_t before = items.fault_count();
  ParsedActions read;
  ActionChain chain(owner);
  for (const JsonReader item : items.items()) {
    const std::size_t faults = items.fault_count();
    const core::Action world = parse_action(item, kDuration);
    if (items.fault_count() != faults) {
      chain.skip();
      continue;
    }
    const core::Action action = chain.append(to_map(world, frame), item);
    // After the first fault only faults matter: items may be many more than actions of that size.
    if (items.fault_count() != before) continue;
    if (!gives_back(action, world, frame)) read.received.keep(read.actions.size(), world);
    read.actions.push_back(action);
  }
  if (items.fault_count() == before && !chain.ends_at_rest()) {
    items.fault(fault::kProfile, [] {
      return "The last action ends at a speed; let the robot come to rest: nothing else is known of what "
             "follows.";
    });
  }
  if (items.fault_count() != before) return std::nullopt;
  return read;
}

}  // namespace fleetplan::api
