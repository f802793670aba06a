#include "core/travel/assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/geometry/segment.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"

namespace fleetplan::core {
namespace TEST_FILE {

using testing::ElementsAre;
using Costs = std::vector<std::vector<double>>;
using Columns = std::vector<std::optional<std::size_t>>;

constexpr double kNo = kForever;

using Importance = std::vector<std::int64_t>;

Columns assigned(const Costs& costs) {
  return *assign(costs, Importance(costs.size(), 1), StopCondition::never());
}

/// The importance of rows without a column, and the sum of the costs of the others.
std::pair<std::int64_t, double> total(const Costs& costs, const Importance& importance,
                                      const Columns& columns) {
  std::pair<std::int64_t, double> total;
  for (std::size_t row = 0; row < costs.size(); ++row) {
    if (columns[row]) {
      total.second += costs[row][*columns[row]];
    } else {
      total.first += importance[row];
    }
  }
  return total;
}

/// The least total of the rows from `row` on, by trying everything.
std::pair<std::int64_t, double> least_total(const Costs& costs, const Importance& importance, std::size_t row,
                                            std::vector<bool>& taken) {
  if (row == costs.size()) return {0, 0.0};
  auto least = least_total(costs, importance, row + 1, taken);
  least.first += importance[row];
  for (std::size_t column = 0; column < taken.size(); ++column) {
    if (taken[column] || costs[row][column] == kNo) continue;
    taken[column] = true;
    auto with = least_total(costs, importance, row + 1, taken);
    taken[column] = false;
    with.second += costs[row][column];
    least = std::min(least, with);
  }
  return least;
}

TEST(Assignment, HasTheLeastSum) {
  EXPECT_THAT(assigned({{1.0, 2.0}, {1.0, 4.0}}), ElementsAre(1U, 0U)) << "2 + 1 < 1 + 4";
}

TEST(Assignment, LeavesTheMostExpensiveRowOut) {
  EXPECT_THAT(assigned({{5.0}, {3.0}, {4.0}}), ElementsAre(std::nullopt, 0U, std::nullopt));
}

TEST(Assignment, LeavesTheLeastImportantRowOut) {
  const auto found = assign({{5.0}, {3.0}, {4.0}}, {2, 1, 1}, StopCondition::never());
  EXPECT_THAT(*found, ElementsAre(0U, std::nullopt, std::nullopt));
}

TEST(Assignment, PrefersMoreRowsToALesserSum) {
  EXPECT_THAT(assigned({{1.0, 1000.0}, {2.0, kNo}}), ElementsAre(1U, 0U));
}

TEST(Assignment, LeavesRowsWithoutAnyColumnOut) {
  EXPECT_THAT(assigned({{kNo, kNo}, {kNo, 1.0}}), ElementsAre(std::nullopt, 1U));
  EXPECT_THAT(assigned({}), ElementsAre());
}

TEST(Assignment, EndsWithTheStop) { EXPECT_FALSE(assign({{1.0}}, {1}, met())); }

TEST(Assignment, IsTheBestOfAllOnRandomCosts) {
  support::Dice dice(7);  // any seed
  for (int run = 0; run < 300; ++run) {
    const auto rows = static_cast<std::size_t>(1 + dice.below(5));
    const auto columns = static_cast<std::size_t>(1 + dice.below(5));
    Costs costs(rows, std::vector<double>(columns));
    for (auto& row : costs) {
      for (double& cost : row) cost = dice.chance(0.2) ? kNo : dice.below(20);
    }
    Importance importance(rows);
    for (std::int64_t& of_row : importance) of_row = 1 + dice.below(3);
    const Columns found = *assign(costs, importance, StopCondition::never());
    std::vector<bool> taken(columns, false);
    EXPECT_EQ(total(costs, importance, found), least_total(costs, importance, 0, taken)) << run;
    for (const auto& column : found) {
      if (!column) continue;
      EXPECT_FALSE(taken[*column]) << "nobody has it twice";
      taken[*column] = true;
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
