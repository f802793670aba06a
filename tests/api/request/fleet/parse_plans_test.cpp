#include "api/request/fleet/parse_plans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "api/request/fleet/parse_robots.h"
#include "api/response/write_response.h"
#include "tests/api/support/requests.h"
#include "tests/support/plan_builder.h"
#include "tests/support/unbounded_work.h"

namespace fleetplan::api {

namespace TEST_FILE {

class RobotNamesTest : public testing::Test {
 protected:
  RobotNamesTest() {
    robots_[0].id = "a";
    robots_[1].id = "b";
  }

  std::optional<std::size_t> find(const RobotNames& names, const std::string& body) {
    auto document = read_json(body, 32, unbounded_work());
    const auto found = names.find(JsonReader(*document));
    faults_ = document->faults.listed();
    return found;
  }

  std::vector<core::Robot> robots_ = std::vector<core::Robot>(2);
  std::vector<Fault> faults_;
};

TEST_F(RobotNamesTest, FindARobotById) {
  EXPECT_EQ(find(RobotNames(robots_), R"("b")"), 1U);
  std::vector<ParsedRobot> read(2);
  read[1].robot.id = "b";
  EXPECT_EQ(find(RobotNames(read), R"("b")"), 1U);
  EXPECT_TRUE(faults_.empty());
}

TEST_F(RobotNamesTest, ReportAnIdThatNoRobotHas) {
  EXPECT_FALSE(find(RobotNames(robots_), R"("c")"));
  ASSERT_EQ(faults_.size(), 1U);
  EXPECT_EQ(faults_[0].code, fault::kUnknownRobot);
  EXPECT_EQ(faults_[0].detail, R"(There is no robot "c" in robots.)");
  EXPECT_FALSE(find(RobotNames(robots_, "robots of the request"), R"("c")"));
  ASSERT_EQ(faults_.size(), 1U);
  EXPECT_EQ(faults_[0].detail, R"(There is no robot "c" in robots of the request.)");
}

TEST_F(RobotNamesTest, ReportWhatIsNoId) {
  for (const char* body : {"7", "null", R"("")"}) {
    EXPECT_FALSE(find(RobotNames(robots_), body));
    EXPECT_EQ(faults_.size(), 1U) << body;
  }
}

core::Robot robot(const std::string& id, double y) {
  core::Robot robot{id, 0.3, 1.0, 2.0, {{0.5, y}, 0.0}, core::Goal{{4.5, y}, 0.0}};
  return robot;
}

/// Two robots that take four seconds for one action each; `b` waits for two seconds before.
class ParseDependencies : public testing::Test {
 protected:
  std::vector<core::Dependency> parse(const std::string& body) {
    auto document = read_json(body, 32, unbounded_work());
    auto dependencies = parse_dependencies(JsonReader(*document), robots_, plans_);
    faults_ = document->faults.listed();
    return dependencies;
  }

  std::vector<core::Robot> robots_{robot("a", 0.5), robot("b", 1.5)};
  std::vector<core::RobotPlan> plans_{
      support::PlanBuilder(0, robots_[0]).translate_to(4.5, 0.5).build(),
      support::PlanBuilder(1, robots_[1]).wait(2.0).translate_to(4.5, 1.5).build()};
  std::vector<Fault> faults_;
};

TEST_F(ParseDependencies, ReadsWhatIsWritten) {
  const core::Dependencies written{{{{1, 1, 0.25}, {0, 0, 0.5}, 1.0}}, {{0, 1, 2.5, 0.0}}};
  JsonWriter json;
  json.begin_object();
  write_dependencies(json, &written, robots_);
  const Json text = Json::parse(json.end_object().take());
  EXPECT_EQ(text["tight"].dump(), R"([{"robots":["a","b"],"t":2.5,"slack":0.0}])");

  const auto read = parse(text["dependencies"].dump());
  EXPECT_TRUE(faults_.empty());
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].gate.robot, 1U);
  EXPECT_EQ(read[0].gate.action, 1U);
  EXPECT_EQ(read[0].gate.fraction, 0.25);
  EXPECT_EQ(read[0].until.robot, 0U);
  EXPECT_EQ(read[0].until.action, 0U);
  EXPECT_EQ(read[0].until.fraction, 0.5);
  EXPECT_EQ(read[0].slack, 1.0);
}

TEST_F(ParseDependencies, ReportsRobotsActionsAndFractionsThatDoNotExist) {
  parse(
      R"([{"gate": {"robot": "c", "action": 0, "progress": 0}, "until": {"robot": "a", "action": 1, "progress": 0}},
            {"gate": {"robot": "a", "action": 0, "progress": 1.5}, "until": {"robot": "b", "action": -1, "progress": 0}}])");
  EXPECT_EQ(brief(faults_), (Faults{{"/0/gate/robot", "unknown_robot"},
                                    {"/0/until/action", "dependency"},
                                    {"/1/gate/progress", "out_of_range"},
                                    {"/1/until/action", "out_of_range"}}));
  EXPECT_THAT(faults_[1].detail, testing::HasSubstr("has 1 actions"));
}

TEST_F(ParseDependencies, ReportsDependenciesThatContradictThePlans) {
  parse(
      R"([{"gate": {"robot": "b", "action": 1, "progress": 0.5}, "until": {"robot": "a", "action": 0, "progress": 0.5}, "slack": 1.5},
            {"gate": {"robot": "a", "action": 0, "progress": 0.5}, "until": {"robot": "b", "action": 1, "progress": 0}},
            {"gate": {"robot": "a", "action": 0, "progress": 0.5}, "until": {"robot": "a", "action": 0, "progress": 0}}])");
  EXPECT_EQ(brief(faults_),
            (Faults{{"/0/slack", "dependency"}, {"/1", "dependency"}, {"/2/until/robot", "dependency"}}));
  EXPECT_THAT(faults_[0].detail, testing::HasSubstr("slack is 2 s, not 1.5 s"));
}

}  // namespace TEST_FILE

}  // namespace fleetplan::api
