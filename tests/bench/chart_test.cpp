#include "tests/bench/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/bench/occurrences.h"

namespace fleetplan::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

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

}  // namespace
}  // namespace fleetplan::bench
