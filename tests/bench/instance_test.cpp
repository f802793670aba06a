#include "tests/bench/instance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "tests/bench/jobs.h"
#include "tests/bench/measure.h"
#include "tests/support/temporary_folder.h"

namespace fleetplan::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

Instance small_instance() {
  Recipe recipe;
  recipe.side = 12;
  recipe.robots = 5;
  return make_instance("small", generate(recipe, 1));
}

TEST(Instance, OfFewerRobotsHasTheFirstOnes) {
  const Instance instance = small_instance();
  ASSERT_EQ(instance.robots(), 5u);
  const json all = json::parse(instance.body(5, json::object()));
  const json two = json::parse(instance.body(2, json::object()));
  ASSERT_EQ(two["robots"].size(), 2u);
  EXPECT_EQ(two["robots"][1], all["robots"][1]);
  EXPECT_EQ(two["map"], all["map"]);
}

TEST(Instance, LetsGivenOptionsWinOverItsOwnAndKeepsTheOthers) {
  json request = json::parse(small_instance().body(1, json::object()));
  request["options"] = {{"mode", "anytime"}, {"max_iterations", 3}};
  const Instance instance("x", request);
  const json body = json::parse(instance.body(1, {{"mode", "first"}}));
  EXPECT_EQ(body["options"], json({{"mode", "first"}, {"max_iterations", 3}}));
}

TEST(Instance, OfAWorkloadIsARequestThatThePlannerSolvesAndTheCheckerPasses) {
  const Instance instance = small_instance();
  const Measurement measurement =
      measure(instance.name(), 5, instance.body(5, {{"time_budget_ms", 10'000}}), {10.0, 1});
  EXPECT_EQ(measurement.fault, "");
  EXPECT_TRUE(measurement.result.solved);
  EXPECT_EQ(measurement.planned, 5u);
  EXPECT_GT(measurement.result.seconds, 0.0);
  EXPECT_GE(measurement.result.flowtime.value(), measurement.lower_bound.value());
  EXPECT_LE(measurement.result.makespan.value(), measurement.result.flowtime.value());
}

TEST(Instance, ThatIsNoValidRequestIsAFault) {
  json request = json::parse(small_instance().body(2, json::object()));
  request["robots"][1]["start"] = request["robots"][0]["start"];
  const Measurement measurement = measure("overlapping", 2, request.dump(), {});
  EXPECT_FALSE(measurement.result.solved);
  EXPECT_THAT(measurement.fault, HasSubstr("/robots/1/start"));
}

TEST(RequestFiles, AreThoseOfAFolderAtAnyDepthThatHoldRequests) {
  const support::TemporaryFolder folder;
  const std::string request = small_instance().body(1, json::object());
  folder.write("b.json", request);
  folder.write("deep/er/a.json", request);
  folder.write("index.json", "[]");
  folder.write("notes.txt", request);
  EXPECT_THAT(request_files({folder.path().string()}),
              ElementsAre(folder.path() / "b.json", folder.path() / "deep/er/a.json"));
  EXPECT_EQ(read_instance("b", folder.path() / "b.json").robots(), 1u);
}

TEST(RequestFiles, ThatCannotBeReadAreNamed) {
  const support::TemporaryFolder folder;
  folder.write("broken.json", "{");
  folder.write("list.json", "[]");
  EXPECT_THROW(request_files({(folder.path() / "none").string()}), std::runtime_error);
  EXPECT_THROW(request_files({folder.path().string()}), std::runtime_error);
  EXPECT_THROW(read_instance("list", folder.path() / "list.json"), std::runtime_error);
}

TEST(Jobs, WithoutFilesAreTheHallsSeedBySeed) {
  Options options;
  options.halls = {"empty", "rects"};
  options.seeds = {4, 5};
  options.robots = {15, 30};
  const auto jobs = jobs_of(options, {});
  std::vector<std::string> names;
  names.reserve(jobs.size());
  for (const Job& job : jobs) names.push_back(job.name);
  EXPECT_THAT(names, ElementsAre("empty/4", "rects/4", "empty/5", "rects/5"));
  EXPECT_THAT(jobs[0].robots, ElementsAre(15, 30));
  EXPECT_EQ(jobs[1].load().robots(), 300u);
}

TEST(Jobs, WithAReferenceAreItsRows) {
  const support::TemporaryFolder folder;
  folder.write("sub/a.json", small_instance().body(5, json::object()));
  Options options;
  options.reference = "reference.csv";
  options.root = folder.path().string();
  const std::vector<Result> reference = {{"sub/a.json", 2, true, 1, 1.0, 1.0, 1.0},
                                         {"empty/3", 15, true, 1, 1.0, 1.0, 1.0},
                                         {"sub/a.json", 4, true, 1, 1.0, 1.0, 1.0}};
  auto jobs = jobs_of(options, reference);
  ASSERT_EQ(jobs.size(), 2u);
  EXPECT_EQ(jobs[0].name, "sub/a.json");
  EXPECT_THAT(jobs[0].robots, ElementsAre(2, 4));
  EXPECT_EQ(jobs[0].load().robots(), 5u);
  EXPECT_EQ(jobs[1].name, "empty/3");

  options.inputs = {(folder.path() / "sub").string()};
  jobs = jobs_of(options, reference);
  ASSERT_EQ(jobs.size(), 1u);
  EXPECT_EQ(jobs[0].name, "sub/a.json") << "as the reference names it";
  EXPECT_THAT(jobs[0].robots, ElementsAre(2, 4));

  EXPECT_THROW(jobs_of({{}, {}, {}, {}, 60.0, {}, 1, false, "", "", "reference.csv", "."},
                       {{"missing.json", 1, true, 1, 1.0, 1.0, 1.0}}),
               std::runtime_error);
}

TEST(Jobs, KnowGeneratedWorkloadsByTheirNames) {
  EXPECT_EQ(workload_name("rects", 12), "rects/12");
  EXPECT_TRUE(named_workload("rects/12"));
  EXPECT_FALSE(named_workload("rects/"));
  EXPECT_FALSE(named_workload("rects/1-2"));
  EXPECT_FALSE(named_workload("maps/1"));
}

}  // namespace
}  // namespace fleetplan::bench
