// What messages name helps: each remedy is taken from the message, applied, and the request is planned.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>

#include "core/plan/planner.h"
#include "core/runtime/random.h"
#include "tests/api/support/requests.h"
#include "tests/support/base64.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::HasSubstr;
using testing::Not;

/// A room of 10 m x 4 m.
Json room() {
  Json request = Json::parse(R"({
    "map": {"rows": ["..........", "..........", "..........", ".........."]},
    "robot_defaults": {"radius": 0.3, "linear_speed": 1.0, "angular_speed": 2.0},
    "robots": [{"id": "a", "start": {"x": 1.5, "y": 1.0}, "goal": {"x": 9.5, "y": 1.0}}]})");
  return request;
}

Json zone(double left, double bottom, double right, double top) {
  return {{"id", "k"},
          {"type", "blocked"},
          {"polygon",
           {{{"x", left}, {"y", bottom}},
            {{"x", right}, {"y", bottom}},
            {{"x", right}, {"y", top}},
            {{"x", left}, {"y", top}}}}};
}

Json robot(const std::string& id, double x, double y) {
  return {{"id", id}, {"start", {{"x", x}, {"y", y}}}};
}

Json goal(double x, double y) { return {{"x", x}, {"y", y}}; }

/// The status of the plan, or the details of the faults.
std::string planned(const Json& request) {
  core::Work work = core::Work::unbounded();
  const auto read = parse_request(request.dump(), Limits{}, work);
  if (!read) return "refused: " + read.failure().detail;
  const core::Plan plan = core::plan(read->problem, read->options, core::StopCondition::never());
  return plan.unplanned.empty() ? "solved" : "unplanned: " + plan.unplanned.front().detail;
}

/// The number after a text in the message.
double number_after(const std::string& message, const std::string& text) {
  const std::size_t at = message.find(text);
  return at == std::string::npos ? std::nan("") : std::stod(message.substr(at + text.size()));
}

/// The place that a message names.
Json nearest_place(const std::string& message) {
  const std::regex form(R"(The nearest place that fits is \((-?[\d.]+), (-?[\d.]+)\), ([\d.e-]+) m away)");
  std::smatch found;
  if (!std::regex_search(message, found, form)) return nullptr;
  return goal(std::stod(found[1]), std::stod(found[2]));
}

TEST(Remedies, NameTheNearestPlaceOfAGoal) {
  Json request = room();
  request["robots"][0]["goal"] = goal(9.72, 1.5);
  EXPECT_EQ(nearest_place(detail_of(request)), goal(9.7, 1.5)) << detail_of(request);
  request["robots"][0]["goal"] = goal(9.72, 3.75);  // a corner
  EXPECT_EQ(nearest_place(detail_of(request)), goal(9.7, 3.7));
  request["options"]["inflation"] = 0.05;
  EXPECT_EQ(nearest_place(detail_of(request)), goal(9.65, 3.65)) << "inflation counts";
  request["map"]["origin"] = goal(-0.1, 1000.3);
  request["robots"][0]["start"] = goal(1.4, 1001.3);
  request["robots"][0]["goal"] = goal(9.62, 1001.8);
  EXPECT_EQ(nearest_place(detail_of(request)), goal(9.55, 1001.8)) << detail_of(request);
}

/// Goals at random on maps and zones at random. A plan exists with the place that is named, and hardly any
/// nearer place fits.
TEST(Remedies, NameNearestPlacesThatFitOnAnyMap) {
  core::Random random(50);
  int named = 0;
  for (int round = 0; round < 60; ++round) {
    Json request = room();
    for (int k = 0; k < 6; ++k) {
      const std::size_t row = random.below(4);
      std::string cells = request["map"]["rows"][row];
      cells[4 + random.below(6)] = '#';
      request["map"]["rows"][row] = cells;
    }
    if (round % 2 == 0) request["zones"] = Json::array({zone(6.2, 0.0, 7.0, 1.0 + random.unit())});
    if (round % 3 == 0) request["options"]["inflation"] = 0.02;
    const double x = 4.0 + 6.0 * random.unit();
    const double y = 4.0 * random.unit();
    request["robots"][0]["goal"] = goal(x, y);
    const auto faults = faults_of(request.dump());
    if (faults.empty()) continue;
    ASSERT_EQ(faults.size(), 1U);
    const Json place = nearest_place(faults.front().detail);
    if (place.is_null()) continue;
    ++named;
    request["robots"][0]["goal"] = place;
    EXPECT_THAT(planned(request), Not(HasSubstr("refused"))) << faults.front().detail;
    EXPECT_THAT(planned(request), Not(HasSubstr("does not fit"))) << faults.front().detail;
    if (request["options"].contains("inflation")) continue;
    const double away = std::hypot(place["x"].get<double>() - x, place["y"].get<double>() - y);
    const double nearer = 0.97 * away - 0.011;
    for (int k = 0; k < 100 && nearer > 0.0; ++k) {
      const double angle = 6.2832 * random.unit();
      const double distance = nearer * std::sqrt(random.unit());
      request["robots"][0]["goal"] = goal(x + distance * std::cos(angle), y + distance * std::sin(angle));
      EXPECT_FALSE(faults_of(request.dump()).empty()) << "nearer than " << place;
    }
  }
  EXPECT_GT(named, 15);
}

TEST(Remedies, OfAStartInAWallIsAnOverlapThatSuffices) {
  for (const double y : {0.299, 0.28, 0.2, 0.1, 0.01}) {
    for (const double inflation : {0.0, 0.03}) {
      Json request = room();
      request["robots"][0]["start"]["y"] = y;
      request["options"]["inflation"] = inflation;
      const std::string detail = detail_of(request);
      const double named = number_after(detail, "options.start_overlap of at least ");
      EXPECT_NEAR(named, 0.3 - y + inflation, 0.0011) << detail;
      request["options"]["start_overlap"] = named;
      EXPECT_EQ(planned(request), "solved") << detail;
    }
  }
  Json request = room();
  request["robots"][0]["start"]["y"] = 0.0;  // half of the disk is in the wall
  EXPECT_THAT(detail_of(request), Not(HasSubstr("start_overlap")));
}

TEST(Remedies, OfAStartInAZoneLeadOut) {
  for (const double x : {3.73, 3.9, 4.2, 5.0}) {
    Json request = room();
    request["zones"] = Json::array({zone(4.0, 0.0, 6.0, 2.0)});
    request["robots"][0]["start"]["x"] = x;
    const std::string detail = detail_of(request);
    EXPECT_THAT(detail, HasSubstr("the zone \"enter\": false"));
    Json entered = request;
    entered["zones"][0]["enter"] = false;
    EXPECT_EQ(planned(entered), "solved") << detail;
    const double named = number_after(detail, "options.start_overlap of at least ");
    EXPECT_EQ(std::isnan(named), x > 4.0) << detail;
    if (std::isnan(named)) continue;
    request["options"]["start_overlap"] = named;
    EXPECT_EQ(planned(request), "solved") << detail;
  }
}

TEST(Remedies, OfStartsThatOverlapIsAnOverlapThatSuffices) {
  for (const double gap : {0.001, 0.03, 0.2}) {
    for (const double inflation : {0.0, 0.02}) {
      Json request = room();
      request["robots"].push_back(robot("b", 1.5, 1.6 - gap));
      request["robots"][1]["goal"] = goal(9.5, 3.0);
      request["options"]["inflation"] = inflation;
      const std::string detail = detail_of(request);
      const double named = number_after(detail, "options.start_overlap of at least ");
      EXPECT_NEAR(named, gap + 2.0 * inflation, 0.0011) << detail;
      request["options"]["start_overlap"] = named;
      EXPECT_EQ(planned(request), "solved") << detail;
    }
  }
}

TEST(Remedies, OfGoalsThatOverlapAreToYieldAndToChoose) {
  Json request = room();
  request["robots"].push_back(robot("b", 1.5, 3.0));
  request["robots"][1]["goal"] = goal(9.5, 1.2);
  const std::string detail = detail_of(request);
  EXPECT_THAT(detail, HasSubstr("\"idle\": \"yield\""));
  EXPECT_THAT(detail, HasSubstr("any_of"));
  for (const std::size_t index : {0U, 1U}) {
    Json yields = request;
    yields["robots"][index]["idle"] = "yield";
    EXPECT_EQ(planned(yields), "solved");
  }
  const Json both{{"any_of", {goal(9.5, 1.0), goal(9.5, 3.0)}}};
  request["robots"][0]["goal"] = both;
  request["robots"][1]["goal"] = both;
  EXPECT_EQ(planned(request), "solved");
}

TEST(Remedies, OfAMaskOfAnotherSizeAreItsResolutionAndOrigin) {
  Json request = room();
  std::string pixels(20 * 4, '\xff');
  for (std::size_t row = 0; row < 4; ++row) pixels[20 * row + 10] = '\0';  // closes the lower half at x = 5
  request["zones"] = Json::array(
      {{{"id", "k"}, {"type", "blocked"}, {"mask", {{"pgm", support::base64("P5 20 4 255\n" + pixels)}}}}});
  EXPECT_THAT(detail_of(request), HasSubstr("give the resolution and the origin of the mask"));
  request["zones"][0]["mask"].update({{"resolution", 0.5}, {"origin", {0.0, 0.0, 0.0}}});
  EXPECT_EQ(planned(request), "solved") << "above it, at y = 2 and more";
  request["robots"][0]["goal"] = goal(5.1, 1.0);
  const Json place = nearest_place(detail_of(request));
  EXPECT_NEAR(place["x"].get<double>(), 4.7, 0.02) << "beside the pixels of half a metre";
  EXPECT_EQ(place["y"], 1.0);
}

TEST(Remedies, OfARobotWithoutAGoalOnACommittedWayIsToYield) {
  Json request = room();
  const auto pose = [](double x) { return Json{{"x", x}, {"y", 1.0}, {"theta", 0.0}}; };
  request["robots"][0]["committed"] = Json::array(
      {{{"type", "translate"}, {"t_start", 0.0}, {"t_end", 7.0}, {"from", pose(1.5)}, {"to", pose(8.5)}}});
  request["robots"].push_back(robot("b", 7.5, 1.0));
  const std::string detail = detail_of(request);
  EXPECT_THAT(detail, HasSubstr("Robot \"b\" has no goal and stays"));
  EXPECT_THAT(detail, HasSubstr("\"idle\": \"yield\""));
  request["robots"][1]["idle"] = "yield";
  EXPECT_EQ(planned(request), "solved");
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
