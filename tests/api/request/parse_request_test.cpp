#include "api/request/parse_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <numbers>

#include "tests/api/support/requests.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

PlanRequest parsed(const Json& request, const Limits& limits = {}) {
  auto result = parse_request(request.dump(), limits, unbounded_work());
  return std::move(*result);
}

TEST(ParseRequest, ReadsTheMapFromTheTopRowDown) {
  Json request = swap_request();
  request["map"] =
      Json::parse(R"({"rows": [".G#@OTW..", ".........", ".........", "#........"], "resolution": 0.5})");
  request["robots"] = Json::parse(R"([{"id": "a", "start": {"x": 3.0, "y": 0.75}}])");
  const PlanRequest read = parsed(request);
  const auto& grid = read.problem.grid();
  EXPECT_EQ(grid.columns(), 9);
  EXPECT_EQ(grid.rows(), 4);
  EXPECT_EQ(grid.resolution(), 0.5);
  EXPECT_TRUE(grid.blocked({0, 0}));
  EXPECT_FALSE(grid.blocked({1, 0}));
  const std::string top = "..#####..";
  for (int column = 0; column < 9; ++column) {
    EXPECT_EQ(grid.blocked({column, 3}), top[static_cast<std::size_t>(column)] == '#') << column;
  }
}

TEST(ParseRequest, ReadsRobotsAndTheirDefaults) {
  Json request = swap_request();
  request["robots"][1]["radius"] = 0.25;
  request["robots"][1]["start"].erase("theta");
  request["robots"][0]["start"]["theta"] = -kPi;
  request["robots"].push_back(
      Json::parse(R"({"id": "parked", "start": {"x": 4.5, "y": 0.5, "theta": 7.0}})"));
  const PlanRequest read = parsed(request);
  const auto& robots = read.problem.robots();
  ASSERT_EQ(robots.size(), 3U);
  EXPECT_EQ(robots[0].id, "a");
  EXPECT_EQ(robots[0].radius, 0.3);
  EXPECT_EQ(robots[0].linear_speed, 1.0);
  EXPECT_EQ(robots[0].angular_speed, 2.0);
  EXPECT_EQ(robots[0].start.theta, kPi);
  EXPECT_FALSE(robots[0].goal->theta);
  EXPECT_EQ(robots[1].radius, 0.25);
  EXPECT_EQ(robots[1].start.theta, 0.0);
  EXPECT_EQ(robots[1].goal->theta, 0.25);
  EXPECT_FALSE(robots[2].goal);
  EXPECT_NEAR(robots[2].start.theta, 7.0 - 2.0 * kPi, 1e-15);
}

TEST(ParseRequest, MovesPositionsIntoTheMapFrame) {
  Json request = swap_request();
  request["map"]["origin"] = {{"x", 500'000.0}, {"y", -20.0}};
  for (auto& robot : request["robots"]) {
    for (const char* pose : {"start", "goal"}) {
      robot[pose]["x"] = robot[pose]["x"].get<double>() + 500'000.0;
      robot[pose]["y"] = robot[pose]["y"].get<double>() - 20.0;
    }
  }
  const PlanRequest read = parsed(request);
  EXPECT_EQ(read.problem.robots()[0].start.position, core::Position(0.5, 1.5));
  EXPECT_EQ(read.frame.to_world({0.5, 1.5}), core::Position(500'000.5, -18.5));
}

TEST(ParseRequest, HasTheDocumentedDefaults) {
  const PlanRequest read = parsed(swap_request());
  EXPECT_EQ(read.options.mode, core::PlanOptions::Mode::first);
  EXPECT_EQ(read.options.objective, core::PlanOptions::Objective::flowtime);
  EXPECT_EQ(read.options.seed, 0U);
  EXPECT_EQ(read.options.priority, core::PlanOptions::Priority::shortest_first);
  EXPECT_EQ(read.options.reordering, core::PlanOptions::Reordering::raise_failed);
  EXPECT_EQ(read.options.start_safe_interval, 3.0);
  EXPECT_EQ(read.options.inflation, 0.0);
  EXPECT_EQ(read.options.wait_before_move, 0.0);
  EXPECT_TRUE(read.options.any_angle);
  EXPECT_EQ(read.options.connectivity, 8);
  EXPECT_FALSE(read.options.max_iterations);
  EXPECT_EQ(read.budget, std::chrono::milliseconds(5000));
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(ParseRequest, ReadsEveryOption) {
  Json request = swap_request();
  request["options"] = Json::parse(R"({
    "time_budget_ms": 12.5, "mode": "anytime", "objective": "makespan", "seed": 18446744073709551615,
    "priority": "longest_first", "reordering": "none", "start_safe_interval": 0, "inflation": 0.125,
    "wait_before_move": 2, "any_angle": false, "connectivity": 32, "max_iterations": 0, "lattice_spacing": 0.25})");
  const PlanRequest read = parsed(request);
  EXPECT_EQ(read.budget, std::chrono::microseconds(12500));
  EXPECT_EQ(read.options.mode, core::PlanOptions::Mode::anytime);
  EXPECT_EQ(read.options.objective, core::PlanOptions::Objective::makespan);
  EXPECT_EQ(read.options.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(read.options.priority, core::PlanOptions::Priority::longest_first);
  EXPECT_EQ(read.options.reordering, core::PlanOptions::Reordering::none);
  EXPECT_EQ(read.options.start_safe_interval, 0.0);
  EXPECT_EQ(read.options.inflation, 0.125);
  EXPECT_EQ(read.options.wait_before_move, 2.0);
  EXPECT_FALSE(read.options.any_angle);
  EXPECT_EQ(read.options.connectivity, 32);
  EXPECT_EQ(read.options.max_iterations, 0);
  EXPECT_EQ(read.options.lattice_spacing, 0.25);
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(ParseRequest, ReadsNullAsNoBoundOfIterations) {
  Json request = swap_request();
  request["options"] = {{"max_iterations", nullptr}};
  EXPECT_FALSE(parsed(request).options.max_iterations);
}

TEST(ParseRequest, ReadsNullAsASpacingToBeChosen) {
  Json request = swap_request();
  request["options"] = {{"lattice_spacing", nullptr}};
  EXPECT_FALSE(parsed(request).options.lattice_spacing);
}

TEST(ParseRequest, ClampsTheBudgetWithAWarning) {
  Json request = swap_request();
  request["options"] = {{"time_budget_ms", 1e300}};
  Limits limits;
  limits.max_budget_ms = 700;
  const PlanRequest read = parsed(request, limits);
  EXPECT_EQ(read.budget, std::chrono::milliseconds(700));
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("clamped from 1e+300 to 700")));
}

TEST(ParseRequest, ClampsTheDefaultBudgetWithoutAWarning) {
  Limits limits;
  limits.max_budget_ms = 700;
  const PlanRequest read = parsed(swap_request(), limits);
  EXPECT_EQ(read.budget, std::chrono::milliseconds(700));
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(ParseRequest, WarnsWhenMaxIterationsHasNoEffect) {
  Json request = swap_request();
  request["options"] = {{"max_iterations", 10}};
  EXPECT_THAT(parsed(request).warnings, ElementsAre(HasSubstr("max_iterations has no effect")));
}

TEST(ParseRequest, ReadsALargeMap) {
  Json request = swap_request();
  request["map"]["rows"] = std::vector<std::string>(1024, std::string(1024, '.'));
  EXPECT_EQ(parsed(request).problem.grid().cell_count(), 1024 * 1024);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
