#include "tests/bench/result_row.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fleetplan::bench {
namespace TEST_FILE {

TEST(ResultRow, HasAsManyValuesAsColumns) {
  const std::string header = csv_header();
  const std::string row = csv_row({});
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
}

TEST(ResultRow, LeavesCostsOfUnsolvedRunsEmpty) {
  Measurement solved;
  solved.file = "empty/1";
  solved.robots = 60;
  solved.solved = true;
  solved.attempts = 2;
  solved.seconds = 0.125;
  solved.flowtime = 2500.5;
  solved.makespan = 130.25;
  EXPECT_TRUE(csv_row(solved).starts_with("empty/1,60,1,2,0.125,2500.5,130.25,"));
  Measurement failed;
  failed.file = "rects/1";
  failed.robots = 300;
  failed.attempts = 9;
  failed.seconds = 60.0;
  EXPECT_TRUE(csv_row(failed).starts_with("rects/1,300,0,9,60,,,"));
}

TEST(ResultRow, ReportsWhetherTheAnswerIsValid) {
  Measurement measurement;
  EXPECT_TRUE(csv_row(measurement).ends_with(",1\n"));
  measurement.fault = "two robots collide";
  EXPECT_TRUE(csv_row(measurement).ends_with(",0\n"));
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
