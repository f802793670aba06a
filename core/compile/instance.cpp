#include "core/compile/instance.h"

#include <algorithm>
#include <map>
#include <utility>

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

/// Where the robots of an instance begin and end; none if only one is planned at a time.
std::vector<Terminals> terminals(const Instance& instance) {
  std::vector<Terminals> all;
  if (instance.problem().one_at_a_time()) return all;
  const double inflation = instance.options().inflation;
  for (std::size_t i = 0; i < instance.size(); ++i) {
    const Itinerary& itinerary = instance.itinerary(i);
    const Lattice& lattice = instance.lattice(i);
    const auto rounding = [&](const Position& p) { return (lattice.snapped(p) - p).norm(); };
    const Body& body = instance.body(i);
    Terminals ends;
    ends.pair_radius = body.pair_radius;
    ends.inflation = inflation + instance.problem().robots()[i].vicinity;
    ends.start = itinerary.pose.position;
    ends.start_rounding = rounding(ends.start);
    ends.radius_at_start = body.radius;
    ends.grows_at_start = growth_at_end(itinerary).has_value();
    if (!itinerary.is_parked() && !itinerary.yields()) {
      ends.goal = itinerary.last_goal().position;
      ends.goal_rounding = rounding(*ends.goal);
      ends.radius_at_goal = itinerary.last_radius();
    }
    all.push_back(ends);
  }
  return all;
}

std::shared_ptr<const FixedReservations> fixed_reservations_of(const Instance& instance,
                                                               const StopCondition& stop) {
  const Problem& problem = instance.problem();
  std::vector<FixedReservations::Committed> robots;
  for (std::size_t i = 0; i < instance.size(); ++i) {
    const Itinerary& itinerary = instance.itinerary(i);
    robots.push_back({instance.views(i).largest_disk(), itinerary.committed.start, itinerary.pose.position,
                      itinerary.t_begin, committed_segments(itinerary), itinerary.load.radius,
                      instance.body(i).radius});
  }
  const Contacts& contacts = instance.contacts();
  return std::make_shared<FixedReservations>(problem.grid().width(), problem.grid().height(),
                                             std::move(robots), problem.obstacles(),
                                             contacts.empty() ? nullptr : &contacts, stop);
}

}  // namespace

Instance::Instance(const Problem& problem, const PlanOptions& options, const StopCondition& stop)
    : Instance(problem, options, nullptr, stop) {
  fixed_reservations_ = fixed_reservations_of(*this, stop);
}

Instance::Instance(const Problem& problem, const PlanOptions& options,
                   std::shared_ptr<const FixedReservations> fixed_reservations, const StopCondition& stop)
    : problem_(problem),
      options_(options),
      lattices_(lattices_of(problem, options)),
      itineraries_(itineraries_of(problem.robots())),
      views_(views_of_robots(problem, options, itineraries_, lattices_, stop)),
      contacts_(terminals(*this), options.interval_margin > 0.0),
      fixed_reservations_(std::move(fixed_reservations)) {}

namespace {

/// More than what a disk in contact with an obstacle overlaps it, rounding included.
constexpr double kMaxOverlap = kContactTolerance + 2.0 * kSamePosition;

/// What is left of a disk that overlaps walls by so much, or by a contact; metres.
double least_radius(double radius, double overlap) {
  return std::max(radius - overlap - kMaxOverlap, kSmallestDisk * radius);
}

}  // namespace

double radius_at_start(const Instance& instance, std::size_t robot) {
  const double radius = instance.body(robot).radius;
  const PlanOptions& options = instance.options();
  const double overlap = std::max(0.0, options.overlap_at_start() - options.inflation);  // of the bare disk
  return instance.sight(robot).fitting_radius(instance.itinerary(robot).pose.position,
                                              least_radius(radius, overlap),
                                              instance.body(robot).wall_radius);
}

double radius_at_goal(const Instance& instance, std::size_t robot, const Position& goal, std::size_t stage,
                      double overlap) {
  const double radius = instance.views(robot)[stage].body.wall_radius;
  return instance.sight(robot).fitting_radius(goal, least_radius(radius, overlap), radius);
}

bool fits_at_start(const Instance& instance, std::size_t robot) {
  return instance.sight(robot).disk_fits(instance.itinerary(robot).pose.position,
                                         instance.body(robot).wall_radius);
}

bool is_clear_at_start(const Instance& instance, std::size_t robot) {
  return radius_at_start(instance, robot) >= instance.body(robot).wall_radius - kMaxOverlap;
}

namespace {

/// Whether walls leave so much of the larger one of the disks with which the robot comes to a goal and leaves
/// it.
bool fits_at_goal(const Instance& instance, std::size_t robot, std::size_t goal, double overlap) {
  const Views& views = instance.views(robot);
  const double largest = std::max(views[goal].body.wall_radius, views[goal + 1].body.wall_radius);
  return instance.sight(robot).disk_fits(instance.itinerary(robot).goals[goal].position,
                                         least_radius(largest, overlap));
}

}  // namespace

bool fits_at_goals(const Instance& instance, std::size_t robot) {
  const std::vector<Goal>& goals = instance.itinerary(robot).goals;
  for (std::size_t k = 0; k < goals.size(); ++k) {
    if (goals[k].anywhere) continue;
    const double overlap = k + 1 == goals.size() ? instance.options().goal_overlap : 0.0;
    if (!fits_at_goal(instance, robot, k, overlap)) return false;
  }
  return true;
}

bool enters_last_goal(const Instance& instance, std::size_t robot) {
  const std::vector<Goal>& goals = instance.itinerary(robot).goals;
  return !goals.back().anywhere && !fits_at_goal(instance, robot, goals.size() - 1, 0.0);
}

bool may_stay_at(const Instance& instance, std::size_t robot, const Position& position) {
  const double radius = instance.body(robot).wall_radius;
  return instance.sight(robot).disk_fits(position, least_radius(radius, instance.options().goal_overlap));
}

}  // namespace fleetplan::core
