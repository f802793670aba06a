#include "tests/bench/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/bench/markdown.h"
#include "tests/bench/paper_claims.h"
#include "tests/bench/report.h"

namespace fleetplan::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::string chart_of(std::vector<ChartPoint> points, bool logarithmic = false) {
  return svg_chart("title", "x", {{"y", logarithmic, {}, {{"line", "#123456", false, std::move(points)}}}});
}

TEST(Chart, DrawsEveryPointOfALine) {
  const std::string chart = chart_of({{10.0, 1.0}, {20.0, 2.0}, {30.0, 1.5}});
  EXPECT_EQ(occurrences(chart, "<circle"), 3u);
  EXPECT_EQ(occurrences(chart, "<polyline"), 1u);
}

TEST(Chart, LeavesOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string chart = chart_of({{10.0, nan}, {20.0, 2.0}, {30.0, 1.0}});
  EXPECT_EQ(occurrences(chart, "<circle"), 2u);
  EXPECT_THAT(chart, Not(HasSubstr("nan")));
}

TEST(Chart, PutsTheEndsOfTheAxesWhereTheyBelong) {
  // Panels are 300 x 220 pixels with their lower left corner at (52, 284).
  const std::string chart = chart_of({{0.0, 0.0}, {10.0, 10.0}});
  EXPECT_THAT(chart, HasSubstr("points=\"52,284 352,64 \""));
}

TEST(Chart, SpacesDecadesEvenlyOnALogarithmicAxis) {
  const std::string chart = chart_of({{0.0, 0.01}, {5.0, 0.1}, {10.0, 1.0}}, true);
  EXPECT_THAT(chart, HasSubstr("points=\"52,284 202,174 352,64 \""));
}

TEST(Chart, CanBeDrawnOfNothingAndOfOnePoint) {
  for (const bool logarithmic : {false, true}) {
    for (const auto& points : {std::vector<ChartPoint>{}, {{0.0, 0.0}}, {{5.0, 1.0}}}) {
      if (logarithmic && !points.empty() && points[0].y <= 0.0) continue;
      const std::string chart = chart_of(points, logarithmic);
      EXPECT_TRUE(chart.ends_with("</svg>\n"));
      EXPECT_THAT(chart, Not(HasSubstr("nan")));
      EXPECT_THAT(chart, Not(HasSubstr("inf")));
    }
  }
}

TEST(Chart, EscapesText) {
  const std::string chart = svg_chart("a < b & \"c\"", "x", {});
  EXPECT_THAT(chart, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
}

TEST(Chart, NamesALineOnceInTheLegend) {
  const ChartLine line{"twice", "#000000", true, {{0.0, 1.0}, {1.0, 2.0}}};
  const std::string chart = svg_chart("t", "x", {{"a", false, {}, {line, line}}, {"b", false, {}, {line}}});
  EXPECT_EQ(occurrences(chart, ">twice<"), 1u);
  EXPECT_EQ(occurrences(chart, "<polyline"), 3u);
}

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
