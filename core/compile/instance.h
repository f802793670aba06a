#pragma once

// A problem with its options, and what is derived from them once. Also: how the disks of robots, inflated or
// not, fit among the walls where plans begin and end.

#include <cstddef>
#include <memory>
#include <vector>

#include "core/compile/views.h"
#include "core/geometry/position.h"
#include "core/map/lattice.h"
#include "core/map/line_of_sight.h"
#include "core/model/body.h"
#include "core/model/itinerary.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/reservation/contacts.h"
#include "core/reservation/fixed_reservations.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Returns the lattice spacing of each robot, metres. The spacing of the options has precedence. By default,
/// the spacing is the map's resolution r.
///
/// Let R be the smallest radius that the robot ever has. If r is at most R / 4, the spacing is larger: the
/// largest odd multiple of r up to R. It is odd so that vertices are still centres of cells. Robots of
/// similar radius share a lattice, and no robot's lattice depends on other robots.
std::vector<double> lattice_spacings(const Problem& problem, const PlanOptions& options);

/// A problem with its options, the lattices, and the moves that walls leave free. None of this changes while
/// one request is planned. Not thread-safe, because static moves are computed on first use.
class Instance {
 public:
  /// If the stop condition is met while obstacles and committed motion are indexed, nothing can be planned.
  Instance(const Problem& problem, const PlanOptions& options, const StopCondition& stop);
  /// Takes the fixed reservations of another instance of the same problem. Of the options, only the
  /// connectivity may differ.
  Instance(const Problem& problem, const PlanOptions& options,
           std::shared_ptr<const FixedReservations> fixed_reservations, const StopCondition& stop);
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  std::size_t size() const { return problem_.robots().size(); }
  const Problem& problem() const { return problem_; }
  const PlanOptions& options() const { return options_; }
  /// What the robot is in each stage of its plan, and where it may be in this stage.
  const Views& views(std::size_t index) const { return views_[index]; }
  /// The robot's body with the load at the beginning of its plan.
  const Body& body(std::size_t index) const { return views_[index][0].body; }
  /// What is left to plan for the robot after its committed actions.
  const Itinerary& itinerary(std::size_t index) const { return itineraries_[index]; }
  const std::vector<Itinerary>& itineraries() const { return itineraries_; }
  /// When the last service of the previous plan ends, for a robot with a goal, seconds; see
  /// previous_service_end().
  double previous_end(std::size_t index) const { return previous_service_end(problem_.robots()[index]); }
  /// The lattice that the robot is planned on.
  const Lattice& lattice(std::size_t index) const { return *lattices_[index]; }
  /// The line of sight of a robot: past walls and past the zones that are blocked for it.
  const LineOfSight& sight(std::size_t index) const { return problem_.map_of(index)->sight(); }
  /// The one past walls alone.
  const LineOfSight& sight_past_walls() const { return problem_.map()->sight(); }
  /// The pairs of robots that begin or end too near to each other.
  const Contacts& contacts() const { return contacts_; }
  /// Obstacles and committed motion; never null. Instances for other threads may share them.
  const std::shared_ptr<const FixedReservations>& fixed_reservations() const { return fixed_reservations_; }

 private:
  const Problem& problem_;
  PlanOptions options_;
  std::vector<std::shared_ptr<const Lattice>> lattices_;  // by robot; robots with the same spacing share a
                                                          // lattice
  std::vector<Itinerary> itineraries_;                    // by robot
  std::vector<Views> views_;                              // by robot
  Contacts contacts_;
  std::shared_ptr<const FixedReservations> fixed_reservations_;
};

/// The largest disk that fits where the robot's plan begins: its radius, or less if a wall is nearer.
double radius_at_start(const Instance& instance, std::size_t robot);
/// The largest disk that fits at the goal of a stage. It may overlap a wall as far as the options allow, or
/// by a contact (metres).
double radius_at_goal(const Instance& instance, std::size_t robot, const Position& goal, std::size_t stage,
                      double overlap);

/// Whether the robot's disk fits where its plan begins.
bool fits_at_start(const Instance& instance, std::size_t robot);
/// Whether the robot's disk is clear of walls where its plan begins; contact is allowed.
bool is_clear_at_start(const Instance& instance, std::size_t robot);
/// Whether the robot's disk fits at all goals that are left. The overlap that is allowed with walls counts as
/// fitting.
bool fits_at_goals(const Instance& instance, std::size_t robot);
/// Whether the robot, which has a goal, overlaps a wall at its last goal by more than a contact.
bool enters_last_goal(const Instance& instance, std::size_t robot);
/// Whether it may stay at this position with its first load, if that is its last goal.
bool may_stay_at(const Instance& instance, std::size_t robot, const Position& position);

}  // namespace fleetplan::core
