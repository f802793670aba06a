#include "core/instance.h"

#include <algorithm>
#include <utility>

#include "core/geometry/tolerance.h"
#include "core/lattice_spacing.h"
#include "core/model/motion_of.h"

namespace fleetplan::core {
namespace {

/// More than what a disk in contact with an obstacle overlaps it, rounding included.
constexpr double kMostOverlap = kContactTolerance + 2.0 * kSamePosition;
/// However much a start may overlap a wall, this fraction of the disk keeps clear of it.
constexpr double kSmallestDisk = 1e-3;

std::vector<Endpoints> endpoints(const Problem& problem, const Lattice& lattice, double inflation) {
  const auto rounding = [&](const Position& p) { return (lattice.snapped(p) - p).norm(); };
  std::vector<Endpoints> all;
  for (const Robot& robot : problem.robots()) {
    Endpoints ends;
    ends.radius = robot.radius + inflation + robot.vicinity;
    ends.inflation = inflation + robot.vicinity;
    ends.start = robot.committed_end().position;
    ends.start_rounding = rounding(ends.start);
    if (robot.goal) {
      ends.goal = robot.goal->position;
      ends.goal_rounding = rounding(*ends.goal);
    }
    all.push_back(ends);
  }
  return all;
}

/// The segments from t = 0 to the end of the commitment, waits included.
std::vector<TimedSegment> committed_segments(const Itinerary& itinerary) {
  if (itinerary.t_begin <= 0.0) return {};
  std::vector<TimedSegment> segments = timed_segments(itinerary.committed);
  std::erase_if(segments, [&](const TimedSegment& segment) { return segment.t_start >= itinerary.t_begin; });
  if (!segments.empty()) segments.back().t_end = std::min(segments.back().t_end, itinerary.t_begin);
  return segments;
}

/// By robot, null for none; or no list.
std::vector<std::unique_ptr<const DriveZones>> drive_zones_of(const Problem& problem) {
  std::vector<std::unique_ptr<const DriveZones>> all;
  const bool any = std::any_of(problem.zones().begin(), problem.zones().end(),
                               [](const Zone& zone) { return zone.type != Zone::Type::blocked; });
  if (!any) return all;
  for (const Robot& robot : problem.robots()) {
    auto zones = std::make_unique<const DriveZones>(problem.zones(), all.size(), robot);
    if (zones->empty()) zones.reset();
    all.push_back(std::move(zones));
  }
  return all;
}

std::shared_ptr<const FixedReservations> fixed(const Problem& problem, double inflation,
                                               const Contacts& contacts, const StopCondition& stop) {
  std::vector<FixedReservations::Robot> robots;
  for (const Robot& robot : problem.robots()) {
    const Itinerary itinerary = itinerary_of(robot);
    robots.push_back({robot.radius, robot.start.position, itinerary.pose.position, itinerary.t_begin,
                      committed_segments(itinerary), robot.vicinity});
  }
  return std::make_shared<FixedReservations>(problem.grid().width(), problem.grid().height(), inflation,
                                             std::move(robots), problem.obstacles(),
                                             contacts.empty() ? nullptr : &contacts, stop);
}

}  // namespace

Instance::Instance(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
    : Instance(problem, options, nullptr, stop) {
  fixed_reservations_ = fixed(problem, options.inflation, contacts_, stop);
}

Instance::Instance(const Problem& problem, const PlanOptions& options,
                   std::shared_ptr<const FixedReservations> fixed_reservations, const StopCondition& stop)
    : problem_(problem),
      options_(options),
      lattice_(problem.grid(), options.connectivity, lattice_spacing(problem, options)),
      drive_zones_(drive_zones_of(problem)),
      contacts_(endpoints(problem, lattice_, options.inflation)),
      fixed_reservations_(std::move(fixed_reservations)) {
  for (const Robot& robot : problem.robots()) {
    const StaticMap& map = *problem.map_of(itineraries_.size());
    itineraries_.push_back(itinerary_of(robot));
    motions_.push_back(motion_of(robot, options));
    auto& space = free_spaces_[{motions_.back().radius, &map}];
    if (!space) {
      auto finer = map.finer_vertices(lattice_, motions_.back().radius, stop);
      space = std::make_unique<FreeSpace>(lattice_, map.sight(), motions_.back().radius, std::move(finer));
    }
    free_space_.push_back(space.get());
  }
}

double Instance::radius_at_start(std::size_t index) const {
  const Robot& robot = problem_.robots()[index];
  const double overlap = std::max(0.0, options_.start_overlap - options_.inflation);  // of the bare disk
  const double least = std::max(robot.radius - overlap - kMostOverlap, kSmallestDisk * robot.radius);
  return sight(index).fitting_radius(itineraries_[index].pose.position, least, motions_[index].radius);
}

bool Instance::fits_at_start(std::size_t index) const {
  return sight(index).disk_fits(itineraries_[index].pose.position, motions_[index].radius);
}

bool Instance::fits_at_goal(std::size_t index) const {
  const std::vector<Goal>& goals = itineraries_[index].goals;
  return std::all_of(goals.begin(), goals.end(), [&](const Goal& goal) {
    return sight(index).disk_fits(goal.position, motions_[index].radius - kMostOverlap);
  });
}

double Instance::longest_plan(std::size_t index) const {
  return std::min(kLongestPlan, kLongestTravel / motions_[index].linear_speed);
}

double Instance::radius_at_goal(std::size_t index, const Position& goal) const {
  const double radius = motions_[index].radius;
  return sight(index).fitting_radius(goal, radius - kMostOverlap, radius);
}

}  // namespace fleetplan::core
