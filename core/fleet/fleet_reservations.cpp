#include "core/fleet/fleet_reservations.h"

#include <algorithm>
#include <utility>

#include "core/model/itinerary.h"

namespace fleetplan::core {
namespace {

/// Seconds: later than any robot leaves the place where it was served.
constexpr double kAfterAllExits = 1e6;

/// The part of contiguous segments from `t` on.
std::vector<SizedSegment> from_time(double t, std::vector<SizedSegment> segments) {
  std::erase_if(segments, [&](const SizedSegment& segment) { return segment.t_end <= t; });
  if (!segments.empty() && segments.front().t_start < t) {
    SizedSegment& first = segments.front();
    if (first.ramp == 0.0) {
      first.path.from += first.velocity() * (t - first.t_start);
      first.t_start = t;
    } else {
      static_cast<TimedSegment&>(first) = first.from_time(t);
    }
  }
  return segments;
}

/// The part of contiguous segments until `t`.
std::vector<SizedSegment> until_time(double t, std::vector<SizedSegment> segments) {
  std::erase_if(segments, [&](const SizedSegment& segment) { return segment.t_start >= t; });
  if (!segments.empty() && segments.back().t_end > t) {
    SizedSegment& last = segments.back();
    if (last.ramp == 0.0) {
      last.path.to = last.path.from + last.velocity() * (t - last.t_start);
      last.t_end = t;
    } else {
      static_cast<TimedSegment&>(last) = last.until_time(t);
    }
  }
  return segments;
}

const Contacts* contacts(const Instance& instance) {
  return instance.contacts().empty() ? nullptr : &instance.contacts();
}

const FixedReservations* fixed_reservations(const Instance& instance) {
  const FixedReservations& fixed = *instance.fixed_reservations();
  return fixed.empty() ? nullptr : &fixed;
}

}  // namespace

std::vector<LargestDisk> largest_disks(const Instance& instance) {
  std::vector<LargestDisk> disks;
  disks.reserve(instance.size());
  for (std::size_t i = 0; i < instance.size(); ++i) disks.push_back(instance.views(i).largest_disk());
  return disks;
}

FleetReservations::FleetReservations(const Instance& instance, OnLeave on_leave)
    : instance_(instance),
      on_leave_(std::move(on_leave)),
      table_(instance.problem().grid().width(), instance.problem().grid().height(),
             instance.problem().grid().resolution(), largest_disks(instance), contacts(instance),
             fixed_reservations(instance), instance.options().interval_margin),
      reserved_{std::vector<std::optional<Trajectory>>(instance.size()),
                std::vector<double>(instance.size(), 0.0)},
      is_ignored_(instance.size(), false) {}

void FleetReservations::follow(std::size_t robot, Trajectory trajectory) {
  const std::vector<SizedSegment> segments = after_commitment(robot, trajectory);
  remove(robot);
  table_.reserve(robot, segments);
  reserved_.trajectories[robot] = std::move(trajectory);
  ++planned_count_;
}

void FleetReservations::stay_in_place(std::size_t robot) { reserve_place(robot, kForever); }

void FleetReservations::reserve_place(std::size_t robot, double seconds) {
  const Itinerary& itinerary = instance_.itinerary(robot);
  const Position& place = itinerary.pose.position;
  remove(robot);
  if (seconds > 0.0) {
    const TimedSegment rest{{place, place}, itinerary.t_begin, itinerary.t_begin + seconds};
    table_.reserve(robot, {{rest, instance_.body(robot).radius}});
  }
  reserved_.holds_place_for[robot] = seconds;
  if (stays(robot)) ++staying_count_;
}

void FleetReservations::remove(std::size_t robot) {
  table_.remove(robot);
  if (trajectory(robot)) --planned_count_;
  reserved_.trajectories[robot].reset();
  if (stays(robot)) {
    --staying_count_;
    on_leave_(robot);
  }
  reserved_.holds_place_for[robot] = 0.0;
}

std::vector<std::size_t> FleetReservations::staying_robots() const {
  std::vector<std::size_t> staying;
  for (std::size_t robot = 0; robot < instance_.size(); ++robot) {
    if (stays(robot) && !is_ignored_[robot]) staying.push_back(robot);
  }
  return staying;
}

/// Whether the robot's reservation is the same as in the snapshot.
bool FleetReservations::is_reserved(std::size_t robot, const Snapshot& among) const {
  const auto& now = trajectory(robot);
  const auto& other = among.trajectories[robot];
  if (now.has_value() != other.has_value()) return false;
  if (!now) return holds_place_for(robot) == among.holds_place_for[robot];
  const auto same_visit = [](const Visit& a, const Visit& b) {
    return a.goal == b.goal && a.t_arrive == b.t_arrive && a.t_leave == b.t_leave;
  };
  return now->cost == other->cost && now->is_previous == other->is_previous &&
         std::equal(now->visits.begin(), now->visits.end(), other->visits.begin(), other->visits.end(),
                    same_visit) &&
         std::equal(now->moves.begin(), now->moves.end(), other->moves.begin(), other->moves.end(),
                    [](const TimedMove& a, const TimedMove& b) {
                      return a.t_start == b.t_start && a.t_end == b.t_end && a.path.to == b.path.to;
                    });
}

void FleetReservations::restore(Snapshot wanted) {
  if (!is_in_table_) on_leave_(std::nullopt);  // others may stay now
  for (std::size_t robot = 0; robot < instance_.size(); ++robot) {
    if (is_in_table_ && is_reserved(robot, wanted)) continue;
    if (wanted.trajectories[robot]) {
      follow(robot, std::move(*wanted.trajectories[robot]));
    } else {
      reserve_place(robot, wanted.holds_place_for[robot]);
    }
  }
  is_in_table_ = true;
}

void FleetReservations::set_without_table(Snapshot wanted) {
  reserved_ = std::move(wanted);
  is_in_table_ = false;
  planned_count_ = 0;
  staying_count_ = 0;
  for (std::size_t robot = 0; robot < instance_.size(); ++robot) {
    if (trajectory(robot)) ++planned_count_;
    if (stays(robot)) ++staying_count_;
  }
}

void FleetReservations::resume() {
  if (!is_in_table_) restore(snapshot());
}

std::vector<std::size_t> FleetReservations::conflicting_robots(std::size_t robot,
                                                               const Trajectory& trajectory) const {
  return table_.robots_hit(robot, after_commitment(robot, trajectory));
}

std::vector<std::size_t> FleetReservations::robots_committed_against(std::size_t robot,
                                                                     const Trajectory& trajectory) const {
  return table_.robots_certainly_hit(robot, after_commitment(robot, trajectory));
}

std::vector<std::size_t> FleetReservations::robots_crossing_place(std::size_t robot) const {
  return conflicting_robots(robot, instance_.itinerary(robot).committed);
}

void FleetReservations::shorten(std::size_t robot, double t) {
  const std::vector<SizedSegment> segments = until_time(t, after_commitment(robot, *trajectory(robot)));
  table_.remove(robot);
  if (!segments.empty()) table_.reserve(robot, segments);
}

void FleetReservations::lengthen(std::size_t robot) {
  table_.remove(robot);
  table_.reserve(robot, after_commitment(robot, *trajectory(robot)));
}

void FleetReservations::reserve_goal(std::size_t robot, std::size_t goal) {
  const Position& place = instance_.itinerary(robot).goals[goal].position;
  table_.reserve(robot,
                 {{{{place, place}, kAfterAllExits, kForever}, instance_.views(robot)[goal].body.radius}});
}

std::vector<SizedSegment> FleetReservations::after_commitment(std::size_t robot,
                                                              const Trajectory& trajectory) const {
  const double t_begin = instance_.itinerary(robot).t_begin;
  std::vector<SizedSegment> segments = sized_segments(instance_.itinerary(robot), trajectory);
  return t_begin > 0.0 ? from_time(t_begin, std::move(segments)) : segments;
}

}  // namespace fleetplan::core
