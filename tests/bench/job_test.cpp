#include "tests/bench/job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/temporary_folder.h"

namespace fleetplan::bench {
namespace TEST_FILE {

using nlohmann::json;
using testing::ElementsAre;

json workload_job() {
  return {{"name", "rects/5"},  {"workload", {{"hall", "rects"}, {"side", 64}, {"seed", 5}, {"robots", 20}}},
          {"robots", {10, 15}}, {"options", {{"mode", "anytime"}}},
          {"budget", 2.5},      {"repeats", 3},
          {"alone", true}};
}

TEST(Job, ReadsItsMembers) {
  const Job job = parse_job(workload_job().dump());
  EXPECT_EQ(job.name, "rects/5");
  EXPECT_THAT(job.robots, ElementsAre(10, 15));
  EXPECT_EQ(job.planning, json({{"mode", "anytime"}}));
  EXPECT_EQ(job.defaults, json::object());
  EXPECT_EQ(job.measure.budget, 2.5);
  EXPECT_EQ(job.measure.repeats, 3);
  EXPECT_TRUE(job.measure.alone);
}

TEST(Job, LoadsAGeneratedWorkload) {
  const Instance instance = load(parse_job(workload_job().dump()));
  EXPECT_EQ(instance.name(), "rects/5");
  EXPECT_EQ(instance.robots(), 20u);
  const Instance same = make_instance("rects/5", generate(hall("rects", 64, 20), 5));
  EXPECT_EQ(instance.body(20, json::object()), same.body(20, json::object()));
}

TEST(Job, LoadsARequestFile) {
  const support::TemporaryFolder folder;
  folder.write("a.json", make_instance("a", generate(hall("empty", 12, 5), 1)).body(5, json::object()));
  json document = workload_job();
  document.erase("workload");
  document["file"] = (folder.path() / "a.json").string();
  EXPECT_EQ(load(parse_job(document.dump())).robots(), 5u);
}

TEST(Job, RejectsAnythingElse) {
  for (const std::string line : {"", "[]", "{", R"({"name": "a"})"})
    EXPECT_THROW(parse_job(line), std::runtime_error) << line;
  json unknown_hall = workload_job();
  unknown_hall["workload"]["hall"] = "round";
  EXPECT_THROW(parse_job(unknown_hall.dump()), std::runtime_error);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::bench
