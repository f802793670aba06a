#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "core/instance/instance.h"
#include "core/runtime/random.h"

namespace fleetplan::core {

/// Robots by index, the highest priority first.
using PriorityOrder = std::vector<std::size_t>;

/// Returns the first order of these robots (ascending, with goals), by the options' priority: by straight
/// distance from start to goal, where a faster robot counts as slightly nearer, as listed, or at random. By
/// distance, a heavy robot (Robot::weight) comes before others that are as far from their goals.
/// Shortest first with a horizon, the robot with the oldest goal comes first, so that nobody is passed over
/// for ever, and those that have arrived come last, so that they make way. Ties keep the order of the list.
PriorityOrder initial_order(const Instance& instance, std::vector<std::size_t> robots, Random& random);
PriorityOrder initial_order(const std::vector<Robot>& all, const PlanOptions& options,
                            std::vector<std::size_t> robots, Random& random);

/// Returns the robots by the time that each takes alone along a straight line, heavy ones sooner.
PriorityOrder order_by_time(const Instance& instance, std::vector<std::size_t> robots);

/// Whether the robots of the order differ in size, inflation and vicinity included.
bool differ_in_size(const Instance& instance, const PriorityOrder& order);

/// Returns a start delay that may give other robots time to get out of the way, seconds: uniform up to the
/// lower bound of a random robot of the order.
double random_start_delay(const Instance& instance, const PriorityOrder& order, Random& random);

/// The orders to try, none of them twice (paper, section Prioritized planning).
class OrderSequence {
 public:
  OrderSequence(PlanOptions::Reordering reordering, PriorityOrder first, Random& random);

  const PriorityOrder& current() const { return current_; }

  /// Moves to the next order after `failed` found no path: gives it the highest priority, or shuffles. Where
  /// raising leads back to an order that has been tried, shuffles as well. Returns false if all orders have
  /// been tried.
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

}  // namespace fleetplan::core
