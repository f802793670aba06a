#pragma once

// Priority orders: the first order, and the orders that follow when a robot fails. Planning in one or more of
// them with restarts. For planning with repairs, see repair.h.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "core/compile/instance.h"
#include "core/fleet/plan_state.h"
#include "core/fleet/progress_report.h"
#include "core/moves/fleet_steps.h"
#include "core/runtime/random.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Robots by index, the highest priority first.
using PriorityOrder = std::vector<std::size_t>;

/// The rank of a robot that takes so many seconds to its last goal; the shortest time comes first. A faster
/// robot counts as only slightly nearer. A heavy robot (Robot::weight) counts as so many times nearer
/// (Smith's rule, 1956).
double rank_by_time(const Itinerary& itinerary, double seconds);

/// Returns the first order of these robots (ascending, with goals), by the options' priority: shortest first,
/// as listed, or at random. Shortest first compares ranks on straight lines to the goals. Ties keep the order
/// of the list.
///
/// Shortest first differs with a horizon: the robot whose goal is oldest comes first, so that no robot is
/// passed over for ever. Robots that have arrived come last, so that they make way.
PriorityOrder initial_order(const Instance& instance, std::vector<std::size_t> robots, Random& random);
PriorityOrder initial_order(const std::vector<Itinerary>& all, const PlanOptions& options,
                            std::vector<std::size_t> robots, Random& random);

/// Returns a random start delay, seconds, that may give other robots time to get out of the way. It is
/// uniform between 0 and the lower bound of a random robot of the order.
double random_start_delay(const Instance& instance, const PriorityOrder& order, Random& random);

/// The orders to try, each at most once (paper, section Prioritized planning).
class OrderSequence {
 public:
  OrderSequence(PlanOptions::Reordering reordering, PriorityOrder first, Random& random);

  const PriorityOrder& current() const { return current_; }

  /// Moves to the next order after `failed` found no path: gives it the highest priority, or shuffles. Also
  /// shuffles if raising leads back to an order that has been tried. Returns false if all orders have been
  /// tried.
  bool advance(std::size_t failed);

  /// Moves to a random order, tried or not.
  void shuffle() { random_.shuffle(current_); }

  /// Removes a robot from all further orders.
  void drop(std::size_t robot);

 private:
  /// Marks the current order as tried. Returns false if it has been tried already.
  bool mark_tried() { return tried_.insert(current_).second; }

  PlanOptions::Reordering reordering_;
  PriorityOrder current_;
  Random& random_;
  std::set<PriorityOrder> tried_;
};

/// The outcome of planning robots in one or more priority orders. The trajectories are in the PlanState.
struct OrderingResult {
  std::vector<std::size_t> unsolved;  // robots without a trajectory, by priority; to be planned once more
  std::vector<std::size_t> given_up;  // at their starts: no path among robots that stay, or too many failures
  /// The robots of given_up that never have a path: not in any order, even if all other robots that may move
  /// are absent.
  std::vector<std::size_t> hopeless;
  std::int64_t attempts = 1;               // times that robots were ordered and planned
  bool cut_off = false;                    // the stop condition was met first
  std::optional<StepsOutcome> steps = {};  // of the last plan in steps, if there was any
};

/// Called when the stop condition of an attempt is met, with the result so far. Returns whether the attempt
/// goes on. If it does, the stop condition is no longer met.
using OnStop = std::function<bool(const OrderingResult& so_far)>;

/// Plans all robots of `order`. Whenever a robot fails, starts again in another order (paper, section
/// Prioritized planning). Ends when all have a trajectory, all orders have failed, or `stop` is met. Leaves
/// the state of the attempt that planned the most robots.
///
/// If all orders fail, tries some random orders in which the first robot starts late. When `stop` is met,
/// `on_stop` (if given) decides whether to go on.
OrderingResult plan_with_restarts(PlanState& state, PriorityOrder order, Random& random,
                                  const StopCondition& stop, ProgressReport& progress,
                                  const OnStop& on_stop = nullptr);

}  // namespace fleetplan::core
