#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "core/instance.h"
#include "core/runtime/random.h"

namespace fleetplan::core {

/// Robots by index, the highest priority first.
using PriorityOrder = std::vector<std::size_t>;

/// The first order of these robots (ascending, with goals), as the options say: by straight distance from
/// start to goal, where a faster robot counts as a little nearer, as listed, or at random; ties as listed.
PriorityOrder initial_order(const Instance& instance, std::vector<std::size_t> robots, Random& random);

/// A time for a robot to hold at its start until others have got out of its way, seconds: up to what a robot
/// of the order, drawn at random, needs to its goal at least.
double random_start_delay(const Instance& instance, const PriorityOrder& order, Random& random);

/// The orders to try one after the other, none of them twice.
class OrderSequence {
 public:
  OrderSequence(PlanOptions::Reordering reordering, PriorityOrder first, Random& random);

  const PriorityOrder& current() const { return current_; }

  /// Goes on to the next order after `failed` found no way: raises it to the top (paper, section Prioritized
  /// planning) or shuffles. Where raising leads back to an order that failed already, shuffles as well. False
  /// if all orders have been tried.
  bool advance(std::size_t failed);

  /// Goes on to any order, tried or not.
  void shuffle() { random_.shuffle(current_); }

  /// Leaves a robot out from now on.
  void drop(std::size_t robot);

 private:
  bool is_new() { return tried_.insert(current_).second; }

  PlanOptions::Reordering reordering_;
  PriorityOrder current_;
  Random& random_;
  std::set<PriorityOrder> tried_;
};

}  // namespace fleetplan::core
