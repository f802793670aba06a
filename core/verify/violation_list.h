#pragma once

#include <cstddef>
#include <vector>

#include "core/verify/verify.h"

namespace fleetplan::core {

/// Violations, of which the first kMostViolations by time, then kind, then robots are kept, and all counted.
class ViolationList {
 public:
  void add(Violation violation);
  void add(ViolationList more);

  std::size_t total() const { return total_; }
  /// Those that are kept, in order; leaves the list empty.
  std::vector<Violation> take();

 private:
  void keep(Violation violation);
  void sort_and_cut();

  std::vector<Violation> kept_;  // at most twice as many as are kept in the end
  std::size_t total_ = 0;
};

}  // namespace fleetplan::core
