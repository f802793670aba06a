#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace fleetplan::bench {

/// Of at least one value.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return std::midpoint(values[(values.size() - 1) / 2], values[values.size() / 2]);
}

}  // namespace fleetplan::bench
