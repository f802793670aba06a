#include "core/instance/instance.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/segment.h"
#include "core/geometry/tolerance.h"
#include "core/model/loads.h"

namespace fleetplan::core {
namespace {

double smallest_radius(const Robot& robot) {
  double smallest = robot.radius;
  for (std::size_t k = 0; k < robot.goal_count(); ++k) {
    smallest = std::min(smallest, robot.goal_at(k).radius_after.value_or(smallest));
  }
  return smallest;
}

}  // namespace

std::vector<double> lattice_spacings(const Problem& problem, const PlanOptions& options) {
  std::vector<double> spacings;
  for (const Robot& robot : problem.robots()) {
    spacings.push_back(options.lattice_spacing
                           ? *options.lattice_spacing
                           : default_lattice_spacing(problem.grid(), smallest_radius(robot)));
  }
  return spacings;
}

namespace {

/// More than what a disk in contact with an obstacle overlaps it, rounding included.
constexpr double kMostOverlap = kContactTolerance + 2.0 * kSamePosition;

/// Bare: with which the plan of the robot begins.
double radius_at_begin(const Robot& robot) {
  return changes_radius(robot) ? radii_of(robot)[itinerary_of(robot).first_goal] : robot.radius;
}

using Lattices = std::vector<std::shared_ptr<const Lattice>>;  // by robot

Lattices lattices_of(const Problem& problem, const PlanOptions& options) {
  std::map<double, std::shared_ptr<const Lattice>> by_spacing;
  Lattices lattices;
  for (const double spacing : lattice_spacings(problem, options)) {
    auto& lattice = by_spacing[spacing];
    if (!lattice) lattice = std::make_shared<const Lattice>(problem.grid(), options.connectivity, spacing);
    lattices.push_back(lattice);
  }
  return lattices;
}

std::vector<Endpoints> endpoints(const Problem& problem, const Lattices& lattices, double inflation) {
  std::vector<Endpoints> all;
  if (problem.one_at_a_time()) return all;
  for (const Robot& robot : problem.robots()) {
    const Lattice& lattice = *lattices[all.size()];
    const auto rounding = [&](const Position& p) { return (lattice.snapped(p) - p).norm(); };
    const double radius = radius_at_begin(robot);
    Endpoints ends;
    ends.pair_radius = radius + inflation + robot.vicinity;
    ends.inflation = inflation + robot.vicinity;
    ends.start = robot.committed_end().position;
    ends.start_rounding = rounding(ends.start);
    ends.radius_at_start = radius;
    ends.grows_at_start = growth_at_end(robot, itinerary_of(robot)).has_value();
    if (robot.goal && !robot.yields()) {
      ends.goal = robot.goal->position;
      ends.goal_rounding = rounding(*ends.goal);
      ends.radius_at_goal = last_radius(robot);
    }
    all.push_back(ends);
  }
  return all;
}

LargestDisk largest_disk_of(const Robot& robot, const PlanOptions& options) {
  const double radius = largest_radius(robot);
  return {radius, radius + options.inflation + robot.vicinity};
}

std::shared_ptr<const FixedReservations> fixed(const Problem& problem, const PlanOptions& options,
                                               const Contacts& contacts, const StopCondition& stop) {
  std::vector<FixedReservations::Robot> robots;
  for (const Robot& robot : problem.robots()) {
    const Itinerary itinerary = itinerary_of(robot);
    robots.push_back({largest_disk_of(robot, options), robot.start.position, itinerary.pose.position,
                      itinerary.t_begin, committed_segments(robot, itinerary), robot.radius,
                      radius_at_begin(robot)});
  }
  return std::make_shared<FixedReservations>(problem.grid().width(), problem.grid().height(),
                                             std::move(robots), problem.obstacles(),
                                             contacts.empty() ? nullptr : &contacts, stop);
}

}  // namespace

Instance::Instance(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
    : Instance(problem, options, nullptr, stop) {
  fixed_reservations_ = fixed(problem, options, contacts_, stop);
}

Instance::Instance(const Problem& problem, const PlanOptions& options,
                   std::shared_ptr<const FixedReservations> fixed_reservations, const StopCondition& stop)
    : problem_(problem),
      options_(options),
      lattices_(lattices_of(problem, options)),
      contacts_(endpoints(problem, lattices_, options.inflation)),
      fixed_reservations_(std::move(fixed_reservations)) {
  const bool any_drive_zone = std::any_of(problem.zones().begin(), problem.zones().end(),
                                          [](const Zone& zone) { return zone.type != Zone::Type::blocked; });
  for (std::size_t i = 0; i < size(); ++i) {
    const Robot& robot = problem.robots()[i];
    const Itinerary& itinerary = itineraries_.emplace_back(itinerary_of(robot));
    stages_.emplace_back();
    const std::optional<DriveZones> zones =
        any_drive_zone ? std::optional<DriveZones>(std::in_place, problem.zones(), i, robot) : std::nullopt;
    if (!core::changes_load(robot)) {
      stages_[i].push_back(make_stage(i, core::first_load(robot), zones, stop));
      continue;
    }
    const std::vector<Load> loads = loads_of(robot);
    const auto first = loads.begin() + static_cast<std::ptrdiff_t>(itinerary.first_goal);
    const bool is_one = std::all_of(first, loads.end(), [&](const Load& load) { return load == *first; });
    std::map<Load, Stage> known;
    for (auto load = first; load != (is_one ? first + 1 : loads.end()); ++load) {
      const auto [stage, is_new] = known.try_emplace(*load);
      if (is_new) stage->second = make_stage(i, *load, zones, stop);
      stages_[i].push_back(stage->second);
    }
  }
}

/// `zones`: those of the robot with its first load, if there are any.
Instance::Stage Instance::make_stage(std::size_t index, const Load& load,
                                     const std::optional<DriveZones>& zones, const StopCondition& stop) {
  const Motion motion = motion_of(robot(index), options_, load);
  const StaticMap& map = *problem_.map_of(index);
  const Lattice& lattice = this->lattice(index);
  auto& space = free_spaces_[{lattice.spacing(), motion.radius, &map}];
  if (!space) {
    auto finer = map.finer_vertices(lattice, motion.radius, stop);
    space = std::make_unique<FreeSpace>(lattice, map.sight(), motion.radius, std::move(finer));
  }
  Stage stage{motion, load, space.get(), nullptr};
  if (!zones) return stage;
  auto loaded = std::make_unique<const DriveZones>(zones->with(load));
  if (!loaded->empty()) stage.zones = drive_zones_.emplace_back(std::move(loaded)).get();
  return stage;
}

LargestDisk Instance::largest_disk(std::size_t index) const {
  return largest_disk_of(robot(index), options_);
}

const Motion& Instance::slimmest_motion(std::size_t index) const {
  const std::vector<Stage>& all = stages_[index];
  return std::min_element(all.begin(), all.end(),
                          [](const Stage& a, const Stage& b) { return a.motion.radius < b.motion.radius; })
      ->motion;
}

std::vector<SizedSegment> Instance::segments(std::size_t index, const Trajectory& trajectory) const {
  const std::vector<TimedSegment> segments = timed_segments(trajectory);
  if (!core::changes_radius(robot(index))) return with_radii(segments, robot(index), {});
  std::vector<Visit> visits = itineraries_[index].visited;
  visits.insert(visits.end(), trajectory.visits.begin(), trajectory.visits.end());
  if (robot(index).goal) visits.push_back({robot(index).via.size(), 0.0, trajectory.last_served});
  return with_radii(segments, robot(index), radius_steps(robot(index), visits));
}

double Instance::radius_at_start(std::size_t index) const {
  const double radius = radius_at_begin(problem_.robots()[index]);
  const double overlap = std::max(0.0, options_.start_overlap - options_.inflation);  // of the bare disk
  const double least = std::max(radius - overlap - kMostOverlap, kSmallestDisk * radius);
  return sight(index).fitting_radius(itineraries_[index].pose.position, least, motion(index).radius);
}

bool Instance::is_clear_at_start(std::size_t index) const {
  return radius_at_start(index) >= motion(index).radius - kMostOverlap;
}

bool Instance::fits_at_start(std::size_t index) const {
  return sight(index).disk_fits(itineraries_[index].pose.position, motion(index).radius);
}

bool Instance::fits_at_goal(std::size_t index) const {
  const std::vector<Goal>& goals = itineraries_[index].goals;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    if (goals[k].anywhere) continue;
    const double largest = std::max(motion(index, k).radius, motion(index, k + 1).radius);
    if (!sight(index).disk_fits(goals[k].position, largest - kMostOverlap)) return false;
  }
  return true;
}

bool Instance::fits_at(std::size_t index, const Position& position) const {
  return sight(index).disk_fits(position, motion(index).radius - kMostOverlap);
}

double Instance::longest_plan(std::size_t index) const {
  double slowest = motion(index).linear_speed;
  for (const Stage& stage : stages_[index]) slowest = std::min(slowest, stage.motion.linear_speed);
  return std::min(kLongestPlan, kLongestTravel / slowest);
}

double Instance::radius_at_goal(std::size_t index, const Position& goal, std::size_t stage) const {
  const double radius = motion(index, stage).radius;
  return sight(index).fitting_radius(goal, radius - kMostOverlap, radius);
}

}  // namespace fleetplan::core
