#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/instance/instance.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/search_space.h"

namespace fleetplan::core {

/// The search spaces of the robots, kept from search to search as far as there is memory: those used least
/// recently are discarded, and computed again when they are needed.
class SearchSpaces {
 public:
  /// `instance` outlives this object.
  explicit SearchSpaces(const Instance& instance);

  /// Returns the search space of a robot, valid until the next call for another robot; null if `stop` is met
  /// before it is made.
  SearchSpace* of(std::size_t robot, const StopCondition& stop);
  void discard_all();

 private:
  struct Entry {
    std::unique_ptr<SearchSpace> space;
    std::int64_t last_use = 0;  // the number of the last call for it
  };

  void make_room();

  const Instance& instance_;
  std::vector<Entry> entries_;  // by robot
  std::int64_t calls_ = 0;
};

}  // namespace fleetplan::core
