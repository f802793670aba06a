#include "tests/bench/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/markdown.h"
#include "tests/bench/occurrences.h"
#include "tests/bench/paper_claims.h"

namespace fleetplan::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(MarkdownTable, IsAligned) {
  EXPECT_EQ(markdown_table({"name", "s"}, {{"a", "1.25"}, {"longer", "-"}}),
            "| name   |    s |\n"
            "|--------|-----:|\n"
            "| a      | 1.25 |\n"
            "| longer |    - |\n");
}

TEST(Numbers, InTablesHaveAsManyDecimalsAsTheyNeed) {
  EXPECT_EQ(decimal(1.005, 2), "1.00");
  EXPECT_EQ(decimal({}, 2), "-");
  EXPECT_EQ(seconds_text(0.00123), "0.0012");
  EXPECT_EQ(seconds_text(0.1234), "0.123");
  EXPECT_EQ(seconds_text(1.234), "1.23");
  EXPECT_EQ(seconds_text(12.34), "12.3");
  EXPECT_EQ(seconds_text({}), "-");
  EXPECT_EQ(mebibytes(0), "0");
  EXPECT_EQ(mebibytes(1), "1");
  EXPECT_EQ(mebibytes(3u << 20), "3");
}

TEST(PaperClaims, AreThoseOfTheTextForTheEmptyHallOnly) {
  EXPECT_EQ(claimed_success("empty", 210), "100 %");
  EXPECT_EQ(claimed_success("empty", 225), "-");
  EXPECT_EQ(claimed_success("empty", 285), "< 10 %");
  EXPECT_EQ(claimed_success("rects", 15), "-");
}

Summary summary_of(std::size_t robots, std::size_t solved) {
  Summary summary;
  summary.robots = robots;
  summary.runs = 4;
  summary.solved = solved;
  summary.median_seconds = 0.5;
  summary.percentile_90_seconds = 2.0;
  summary.largest_seconds = 3.0;
  if (solved > 0) summary.flowtime_by_bound = 1.25;
  return summary;
}

TEST(ClosingLines, CountFaultsAndTellABusyMachine) {
  Measurement idle;
  idle.result.seconds = 1.0;
  idle.cpu_seconds = 0.99;
  idle.peak_memory = 5u << 20;
  Measurement busy = idle;
  busy.cpu_seconds = 0.5;
  busy.fault = "two robots collide";
  EXPECT_THAT(closing_lines({idle}), HasSubstr("Plans: 1, all checked in continuous time; at fault: 0."));
  EXPECT_THAT(closing_lines({idle}), Not(HasSubstr("busy")));
  EXPECT_THAT(closing_lines({idle, busy}),
              HasSubstr("Plans: 2, all checked in continuous time; at fault: 1."));
  EXPECT_THAT(closing_lines({idle, busy}),
              HasSubstr("5 MiB. Wall time 2.00 s, CPU time 1.49 s: the machine was busy"));
}

TEST(HallReport, TellsTheSuccessRateBesideThePapers) {
  const std::string table = hall_table({"empty", {summary_of(15, 3), summary_of(300, 0)}});
  EXPECT_THAT(table, HasSubstr("| 15            |   75 % |  100 % |"));
  EXPECT_THAT(table, HasSubstr("| 300           |    0 % | < 10 % |"));
}

TEST(HallReport, DrawsSuccessTimeAndCostOfEveryHall) {
  const std::string chart =
      hall_chart({{"empty", {summary_of(15, 4), summary_of(300, 0)}}, {"rects", {summary_of(15, 4)}}});
  EXPECT_EQ(occurrences(chart, "font-weight=\"bold\">"), 4u) << "a title and three panels";
  // Two halls in each panel, the 90 % lines, and the paper's line in two pieces.
  EXPECT_EQ(occurrences(chart, "<polyline"), 2u * 3u + 2u + 2u);
}

}  // namespace
}  // namespace fleetplan::bench
