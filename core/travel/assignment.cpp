#include "core/travel/assignment.h"

#include <compare>
#include <cstdint>
#include <limits>

#include "core/geometry/segment.h"

namespace fleetplan::core {
namespace {

/// The cost of an assignment, or a difference of costs: the importance of rows without a column, and the sum
/// of the other costs. The sum matters only if the importance is the same.
struct Cost {
  std::int64_t without = 0;
  double sum = 0.0;

  auto operator<=>(const Cost&) const = default;  // NOLINT(modernize-use-nullptr): its own 0
  Cost operator+(const Cost& other) const { return {without + other.without, sum + other.sum}; }
  Cost operator-(const Cost& other) const { return {without - other.without, sum - other.sum}; }
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Adds row after row. Each row gets a column by the cheapest change of the assignment so far: an alternating
/// path from the row to a free column. Dijkstra's algorithm finds it, on costs reduced by the potentials of
/// rows and columns, which are >= 0. In addition to the real columns, each row has its own column that stands
/// for none.
class Assignment {
 public:
  Assignment(const std::vector<std::vector<double>>& costs, const std::vector<std::int64_t>& importance)
      : costs_(costs),
        importance_(importance),
        real_(costs.empty() ? 0 : costs.front().size()),
        of_row_(costs.size()),
        of_column_(real_ + costs.size()),
        row_of_(real_ + costs.size(), kNone) {}

  /// Returns false if the stop is met first.
  bool add(std::size_t row, const StopCondition& stop) {
    const std::size_t columns = row_of_.size();
    distance_.assign(columns, std::nullopt);
    before_.assign(columns, kNone);
    is_done_.assign(columns, false);
    Cost reached;
    std::size_t column = kNone;  // the column that was reached last
    do {
      if (stop.met()) return false;
      const std::size_t here = column == kNone ? row : row_of_[column];
      relax(here, column, reached);
      column = nearest();
      reached = *distance_[column];
      is_done_[column] = true;
    } while (row_of_[column] != kNone);
    change_potentials(row, reached);
    while (column != kNone) {
      const std::size_t from = before_[column];
      row_of_[column] = from == kNone ? row : row_of_[from];
      column = from;
    }
    return true;
  }

  std::vector<std::optional<std::size_t>> columns() const {
    std::vector<std::optional<std::size_t>> columns(costs_.size());
    for (std::size_t column = 0; column < real_; ++column) {
      if (row_of_[column] != kNone) columns[row_of_[column]] = column;
    }
    return columns;
  }

 private:
  /// None if the row cannot have the column.
  std::optional<Cost> cost(std::size_t row, std::size_t column) const {
    if (column >= real_)
      return column == real_ + row ? std::optional(Cost{importance_[row], 0.0}) : std::nullopt;
    const double sum = costs_[row][column];
    return sum < kForever ? std::optional(Cost{0, sum}) : std::nullopt;
  }

  /// Offers the columns that a row may have, which has been reached by the column that it has.
  void relax(std::size_t row, std::size_t by, const Cost& reached) {
    const auto offer = [&](std::size_t column) {
      const auto own = is_done_[column] ? std::nullopt : cost(row, column);
      if (!own) return;
      const Cost through = reached + (*own - of_row_[row] - of_column_[column]);
      if (distance_[column] && !(through < *distance_[column])) return;
      distance_[column] = through;
      before_[column] = by;
    };
    for (std::size_t column = 0; column < real_; ++column) offer(column);
    offer(real_ + row);
  }

  /// There always is a column, because the row that was added may have none.
  std::size_t nearest() const {
    std::size_t nearest = kNone;
    for (std::size_t column = 0; column < distance_.size(); ++column) {
      if (is_done_[column] || !distance_[column]) continue;
      if (nearest == kNone || *distance_[column] < *distance_[nearest]) nearest = column;
    }
    return nearest;
  }

  /// Keeps reduced costs >= 0, and 0 for the pairs of the assignment.
  void change_potentials(std::size_t row, const Cost& reached) {
    of_row_[row] = of_row_[row] + reached;
    for (std::size_t column = 0; column < distance_.size(); ++column) {
      if (!is_done_[column]) continue;
      const Cost nearer = reached - *distance_[column];
      of_column_[column] = of_column_[column] - nearer;
      if (row_of_[column] != kNone) of_row_[row_of_[column]] = of_row_[row_of_[column]] + nearer;
    }
  }

  const std::vector<std::vector<double>>& costs_;
  const std::vector<std::int64_t>& importance_;
  const std::size_t real_;           // columns
  std::vector<Cost> of_row_;         // potentials
  std::vector<Cost> of_column_;      // potentials
  std::vector<std::size_t> row_of_;  // by column
  // The search for one row, by column:
  std::vector<std::optional<Cost>> distance_;
  std::vector<std::size_t> before_;  // the column before it on the path, kNone for the row that was added
  std::vector<bool> is_done_;
};

}  // namespace

std::optional<std::vector<std::optional<std::size_t>>> assign(const std::vector<std::vector<double>>& costs,
                                                              const std::vector<std::int64_t>& importance,
                                                              const StopCondition& stop) {
  Assignment assignment(costs, importance);
  for (std::size_t row = 0; row < costs.size(); ++row) {
    if (!assignment.add(row, stop)) return std::nullopt;
  }
  return assignment.columns();
}

}  // namespace fleetplan::core
