#include "api/request/robot_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

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
  std::vector<ReadRobot> read(2);
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

}  // namespace TEST_FILE
}  // namespace fleetplan::api
