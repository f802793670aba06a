#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Gives each row at most one column, and each column to at most one row. It minimizes the total importance
/// of the rows without a column. The importance of each row is > 0, so as many rows as possible have a
/// column. Among these assignments, it minimizes the sum of the costs (shortest augmenting paths; Kuhn, 1955;
/// Jonker and Volgenant, 1987).
///
/// `costs[row][column]` are finite, or kForever if the row cannot have the column. All rows are of equal
/// length. Returns the column of each row. No assignment if `stop` is met first.
std::optional<std::vector<std::optional<std::size_t>>> assign(const std::vector<std::vector<double>>& costs,
                                                              const std::vector<std::int64_t>& importance,
                                                              const StopCondition& stop);

}  // namespace fleetplan::core
