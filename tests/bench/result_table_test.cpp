#include "tests/bench/result_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace fleetplan::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<Result> read(const std::string& text) {
  std::istringstream stream(text);
  return read_results(stream);
}

TEST(ResultTable, ReadsWhatItWrites) {
  Measurement solved;
  solved.result = {"empty/1", 60, true, 2, 0.125, 2500.5, 130.25};
  Measurement failed;
  failed.result = {"rects/1", 300, false, 9, 60.0, {}, {}};
  const auto results = read(csv_header() + csv_row(solved) + csv_row(failed));
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].file, "empty/1");
  EXPECT_EQ(results[0].robots, 60u);
  EXPECT_TRUE(results[0].solved);
  EXPECT_EQ(results[0].attempts, 2);
  EXPECT_EQ(results[0].seconds, 0.125);
  EXPECT_EQ(results[0].flowtime, 2500.5);
  EXPECT_EQ(results[0].makespan, 130.25);
  EXPECT_FALSE(results[1].solved);
  EXPECT_FALSE(results[1].flowtime);
}

TEST(ResultTable, HasAsManyValuesAsColumns) {
  const std::string header = csv_header();
  const std::string row = csv_row({});
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
}

TEST(ResultTable, TellsAnswersAtFaultFromOthers) {
  Measurement measurement;
  EXPECT_TRUE(csv_row(measurement).ends_with(",1\n"));
  measurement.fault = "two robots collide";
  EXPECT_TRUE(csv_row(measurement).ends_with(",0\n"));
}

TEST(ResultTable, ReadsColumnsInAnyOrderWithOthersBetween) {
  const auto results = read(
      "robots,note,makespan,flowtime,seconds,attempts,solved,file\r\n"
      "15,x,2.5,3.5,0.5,1,1,a.json\r\n");
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].file, "a.json");
  EXPECT_EQ(results[0].makespan, 2.5);
}

TEST(ResultTable, SaysInWhichLineAFaultIs) {
  const std::string head = "file,robots,solved,attempts,seconds,flowtime,makespan\n";
  const auto reading = [](const std::string& text) { return [text] { read(text); }; };
  EXPECT_THAT(reading(head + "a,1,1,1,1,1,1\na,one,1,1,1,1,1\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("line 3: 'one' is no number of column robots")));
  EXPECT_THAT(reading(head + "a,1\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("line 2: as many values")));
  EXPECT_THAT(reading("file,robots\na,1\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no column solved")));
}

}  // namespace
}  // namespace fleetplan::bench
