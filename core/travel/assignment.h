#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/runtime/stop_condition.h"

namespace fleetplan::core {

/// Gives each row at most one column, and each column to at most one row. The importance of the rows without
/// a column is the least one in sum, which is > 0 for each row; so as many rows as possible have one. Among
/// these assignments, the sum of the costs is the least one (shortest augmenting paths; Kuhn, 1955; Jonker
/// and Volgenant, 1987). `costs[row][column]` are finite, or kForever where the row cannot have the column;
/// all rows are of equal length. Returns the column of each row. No assignment if `stop` is met first.
std::optional<std::vector<std::optional<std::size_t>>> assign(const std::vector<std::vector<double>>& costs,
                                                              const std::vector<std::int64_t>& importance,
                                                              const StopCondition& stop);

}  // namespace fleetplan::core
