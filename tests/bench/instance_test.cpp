#include "tests/bench/instance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/bench/measure.h"
#include "tests/support/temporary_folder.h"

namespace fleetplan::bench {
namespace TEST_FILE {

using nlohmann::json;
using testing::HasSubstr;
using testing::ThrowsMessage;

Instance small_instance() { return make_instance("small", generate(hall("empty", 12, 5), 1)); }

TEST(Instance, WithFewerRobotsHasTheFirstOnes) {
  const Instance instance = small_instance();
  ASSERT_EQ(instance.robots(), 5u);
  const json all = json::parse(instance.body(5, json::object()));
  const json two = json::parse(instance.body(2, json::object()));
  ASSERT_EQ(two["robots"].size(), 2u);
  EXPECT_EQ(two["robots"][1], all["robots"][1]);
  EXPECT_EQ(two["map"], all["map"]);
}

TEST(Instance, OverridesItsOptionsAndKeepsTheOthers) {
  json request = json::parse(small_instance().body(1, json::object()));
  request["options"] = {{"mode", "anytime"}, {"max_iterations", 3}};
  const Instance instance("x", request);
  const json body = json::parse(instance.body(1, {{"mode", "first"}}));
  EXPECT_EQ(body["options"], json({{"mode", "first"}, {"max_iterations", 3}}));
}

TEST(Instance, GivesRobotsWhatTheyDoNotHave) {
  json request = json::parse(small_instance().body(1, json::object()));
  request["robot_defaults"] = {{"vicinity", 0.1}, {"linear_acceleration", 2.0}};
  const Instance instance("x", request);
  const json body = json::parse(instance.body(1, json::object(), {{"linear_acceleration", 1.0}}));
  EXPECT_EQ(body["robot_defaults"], json({{"vicinity", 0.1}, {"linear_acceleration", 1.0}}));
}

TEST(Instance, OfAWorkloadIsSolvedAndValid) {
  const Instance instance = small_instance();
  const Measurement measurement =
      measure(instance.name(), 5, instance.body(5, {{"time_budget_ms", 10'000}}), {10.0, 1});
  EXPECT_EQ(measurement.fault, "");
  EXPECT_TRUE(measurement.solved);
  EXPECT_EQ(measurement.planned, 5u);
  EXPECT_GT(measurement.seconds, 0.0);
  EXPECT_GE(measurement.flowtime.value(), measurement.lower_bound.value());
  EXPECT_LE(measurement.makespan.value(), measurement.flowtime.value());
}

TEST(Instance, ThatIsInvalidIsAFault) {
  json request = json::parse(small_instance().body(2, json::object()));
  request["robots"][1]["start"] = request["robots"][0]["start"];
  const Measurement measurement = measure("overlapping", 2, request.dump(), {});
  EXPECT_FALSE(measurement.solved);
  EXPECT_THAT(measurement.fault, HasSubstr("/robots/1/start"));
}

TEST(Instance, IsReadFromAFile) {
  const support::TemporaryFolder folder;
  folder.write("b.json", small_instance().body(1, json::object()));
  EXPECT_EQ(read_instance("b", folder.path() / "b.json").robots(), 1u);
}

TEST(Instance, ThatCannotBeReadIsNamed) {
  const support::TemporaryFolder folder;
  folder.write("broken.json", "{");
  folder.write("list.json", "[]");
  for (const char* name : {"none.json", "broken.json", "list.json"}) {
    const auto reading = [&] { read_instance(name, folder.path() / name); };
    EXPECT_THAT(reading, ThrowsMessage<std::runtime_error>(HasSubstr(name)));
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
