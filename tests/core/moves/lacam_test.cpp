#include "core/moves/lacam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "core/moves/step_lines.h"
#include "tests/core/support/planning.h"
#include "tests/support/random_problem.h"
#include "tests/support/sanitized.h"

namespace fleetplan::core {
namespace TEST_FILE {

constexpr int kNone = StepProblem::kNone;

/// The steps between the free cells of a map, '.'; vertices are numbered row by row.
StepProblem::Neighbours graph_of(const std::vector<std::string>& rows) {
  const int width = static_cast<int>(rows.front().size());
  const int height = static_cast<int>(rows.size());
  const auto is_free = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < width && y < height &&
           rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '.';
  };
  StepProblem::Neighbours graph(static_cast<std::size_t>(width * height), {kNone, kNone, kNone, kNone});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!is_free(x, y)) continue;
      auto& next = graph[static_cast<std::size_t>(y * width + x)];
      const std::array<std::array<int, 2>, 4> around{{{x + 1, y}, {x - 1, y}, {x, y + 1}, {x, y - 1}}};
      for (std::size_t k = 0; k < around.size(); ++k) {
        if (is_free(around[k][0], around[k][1])) next[k] = around[k][1] * width + around[k][0];
      }
    }
  }
  return graph;
}

StepProblem on_map(const std::vector<std::string>& rows, std::vector<StepProblem::Mover> movers) {
  return {{graph_of(rows)}, std::move(movers)};
}

std::optional<std::vector<Configuration>> plan_with_seed(const StepProblem& problem, std::uint64_t seed = 0) {
  Random random(seed);
  return plan_steps(problem, random, StopCondition::never());
}

bool has_step(const StepProblem& problem, std::size_t robot, int from, int to) {
  const auto& next = problem.graphs[problem.movers[robot].graph][static_cast<std::size_t>(from)];
  return from == to || std::find(next.begin(), next.end(), to) != next.end();
}

/// Finds the robot that comes to the place of this robot, if any, then the robot that comes to that one's
/// place, and so on. Returns whether this leads back to the first robot. An exchange is a cycle of two.
bool goes_round(std::size_t robot, const Configuration& from, const Configuration& to) {
  std::size_t k = robot;
  for (std::size_t count = 0; count < from.size(); ++count) {
    const auto behind = std::find(to.begin(), to.end(), from[k]);
    if (behind == to.end()) return false;
    const auto next = static_cast<std::size_t>(behind - to.begin());
    if (next == k) return false;
    if (next == robot) return true;
    k = next;
  }
  return false;
}

void expect_valid(const StepProblem& problem, const std::vector<Configuration>& plan) {
  for (std::size_t i = 0; i < problem.movers.size(); ++i) {
    EXPECT_EQ(plan.front()[i], problem.movers[i].start);
    EXPECT_EQ(plan.back()[i], problem.movers[i].goal);
  }
  for (std::size_t k = 0; k < plan.size(); ++k) {
    EXPECT_EQ(std::set<int>(plan[k].begin(), plan[k].end()).size(), problem.movers.size()) << "step " << k;
    for (std::size_t i = 0; k > 0 && i < problem.movers.size(); ++i) {
      EXPECT_TRUE(has_step(problem, i, plan[k - 1][i], plan[k][i])) << "robot " << i << ", step " << k;
      EXPECT_FALSE(goes_round(i, plan[k - 1], plan[k])) << "robot " << i << ", step " << k;
    }
  }
}

TEST(Lacam, MovesARobotAloneWithoutDetour) {
  const StepProblem problem = on_map({"....",  //
                                      ".##.",  //
                                      "...."},
                                     {{0, 0, 11}});
  const auto plan = plan_with_seed(problem);
  ASSERT_TRUE(plan);
  expect_valid(problem, *plan);
  EXPECT_EQ(plan->size(), 6u);
}

TEST(Lacam, LetsTwoRobotsChangePlacesInACorridorWithOneBay) {
  const StepProblem problem = on_map({"##.####",  //
                                      "......."},
                                     {{0, 8, 13}, {0, 12, 7}});
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto plan = plan_with_seed(problem, seed);
    ASSERT_TRUE(plan) << "seed " << seed;
    expect_valid(problem, *plan);
  }
}

TEST(Lacam, EndsWhereThereIsNoPlan) {
  EXPECT_FALSE(plan_with_seed(on_map({"...."}, {{0, 0, 3}, {0, 3, 0}}))) << "no room to pass each other";
  EXPECT_FALSE(plan_with_seed(on_map({".#."}, {{0, 0, 2}}))) << "no way";
  EXPECT_FALSE(plan_with_seed(on_map({"..",  //
                                      ".."},
                                     {{0, 0, 1}, {0, 1, 3}, {0, 3, 2}, {0, 2, 0}})))
      << "only a cycle";
}

TEST(Lacam, EndsWhenStopped) {
  Random random(0);
  EXPECT_FALSE(plan_steps(on_map({"...."}, {{0, 0, 3}}), random, met()));
}

TEST(Lacam, DoesWithoutRobots) {
  EXPECT_EQ(plan_with_seed(on_map({"...."}, {})), std::vector<Configuration>{{}});
}

/// A robot of the second kind does not fit through the gate.
TEST(Lacam, KeepsEachKindOfRobotToItsGraph) {
  StepProblem problem = on_map({"...",  //
                                "#.#",  //
                                "..."},
                               {{0, 0, 8}, {1, 2, 0}});
  problem.graphs.push_back(graph_of({"...",  //
                                     "###",  //
                                     "..."}));
  const auto plan = plan_with_seed(problem);
  ASSERT_TRUE(plan);
  expect_valid(problem, *plan);
}

/// Aisles of one cell between shelves, with a border of one cell around.
std::vector<std::string> aisles(int columns, int rows) {
  std::vector<std::string> map;
  for (int y = 0; y < 3 * rows + 1; ++y) {
    std::string row(static_cast<std::size_t>(5 * columns + 1), '.');
    for (int x = 0; y % 3 != 0 && x < 5 * columns; ++x) {
      if (x % 5 != 0) row[static_cast<std::size_t>(x)] = '#';
    }
    map.push_back(row);
  }
  return map;
}

/// The vertices with a way to another vertex.
std::vector<int> joined_vertices(const StepProblem::Neighbours& graph) {
  std::vector<int> vertices;
  for (std::size_t v = 0; v < graph.size(); ++v) {
    if (std::count(graph[v].begin(), graph[v].end(), kNone) < 4) vertices.push_back(static_cast<int>(v));
  }
  return vertices;
}

TEST(Lacam, PlansRandomFleetsOfAnyDensity) {
  for (std::uint64_t seed = 0; seed < (support::kSanitized ? 60U : 200U); ++seed) {
    support::Dice dice(seed);
    StepProblem problem{{graph_of(aisles(2 + dice.below(4), 1 + dice.below(4)))}, {}};
    const std::vector<int> vertices = joined_vertices(problem.graphs[0]);
    Random random(seed);
    std::vector<int> starts = vertices, goals = vertices;
    random.shuffle(starts);
    random.shuffle(goals);
    const auto count = 1 + random.below(vertices.size() / 2);
    for (std::size_t i = 0; i < count; ++i) problem.movers.push_back({0, starts[i], goals[i]});
    const auto plan = plan_with_seed(problem, seed);
    ASSERT_TRUE(plan) << "seed " << seed << ", " << count << " robots on " << vertices.size() << " vertices";
    expect_valid(problem, *plan);
  }
}

/// Robots of the second kind do not fit everywhere. No robot may pull them to places where they do not fit.
TEST(Lacam, KeepsRandomFleetsOfTwoKindsToTheirGraphs) {
  int planned = 0;
  for (std::uint64_t seed = 0; seed < (support::kSanitized ? 100U : 300U); ++seed) {
    support::Dice dice(seed);
    std::vector<std::string> rows = aisles(2 + dice.below(2), 1 + dice.below(3));
    StepProblem problem{{graph_of(rows)}, {}};
    for (std::string& row : rows) {
      for (char& cell : row) {
        if (cell == '.' && dice.chance(0.15)) cell = '#';
      }
    }
    problem.graphs.push_back(graph_of(rows));
    const std::vector<int> vertices = joined_vertices(problem.graphs[1]);
    Random random(seed);
    std::vector<int> starts = vertices, goals = vertices;
    random.shuffle(starts);
    random.shuffle(goals);
    const auto count = 1 + random.below(vertices.size() / 3);
    for (std::size_t i = 0; i < count; ++i) problem.movers.push_back({random.below(2), starts[i], goals[i]});
    const auto plan = plan_with_seed(problem, seed);
    if (!plan) continue;  // the second kind may have no way
    ++planned;
    expect_valid(problem, *plan);
  }
  EXPECT_GT(planned, support::kSanitized ? 15 : 50);
}

TEST(Lacam, TellsAtOnceThatRobotsCannotPassOnALine) {
  const std::string line(200, '.');
  // All configurations are too many to be looked at.
  const StepProblem problem = on_map({line}, {{0, 0, 199}, {0, 1, 198}, {0, 2, 197}, {0, 3, 196}});
  EXPECT_TRUE(have_to_pass_on_a_line(problem, StopCondition::never()));
  EXPECT_FALSE(plan_with_seed(problem));
}

TEST(Lacam, RobotsPassOnALineWithABranch) {
  const StepProblem turned = on_map({"....", "#.##"}, {{0, 0, 2}, {0, 2, 0}});
  EXPECT_FALSE(have_to_pass_on_a_line(turned, StopCondition::never()));
  const StepProblem same_order = on_map({"...."}, {{0, 0, 2}, {0, 1, 3}});
  EXPECT_FALSE(have_to_pass_on_a_line(same_order, StopCondition::never()));
  EXPECT_TRUE(plan_with_seed(same_order));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::core
