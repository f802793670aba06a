// What POST /v1/margins promises. Plans of random fleets that are `met` are executed again with other seeds.
// At most the share that the confidence allows may have more bad runs than the aim. The same check finds a
// test whose error is planted.
//
// FLEETPLAN_MARGIN_FLEETS and FLEETPLAN_MARGIN_RUNS make it longer; FLEETPLAN_FIRST_SEED begins elsewhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/execution/execution_requests.h"
#include "core/plan/margins.h"
#include "tests/api/support/answers.h"
#include "tests/api/support/life_requests.h"
#include "tests/api/support/lives.h"
#include "tests/api/support/requests.h"
#include "tests/support/sanitized.h"

namespace fleetplan::api {
namespace TEST_FILE {

constexpr std::uint64_t kFleets = support::kSanitized ? 6 : 24;
constexpr std::uint64_t kRunsAgain = support::kSanitized ? 400 : 2000;
// With a planted error about one search in six has a plan that is met, so only many tell; each fleet has
// some.
constexpr std::uint64_t kPlantedSearches = 48;
constexpr std::uint64_t kPlantedRuns = 2000;  // at least
constexpr std::size_t kMostRobots = 8;

/// A small fleet with loads, accelerations, zones and open goals, half of them in motion.
Json small_fleet(support::Dice& dice) {
  while (true) {
    Json request = first_request(dice);
    if (request["robots"].size() > kMostRobots) continue;
    request["map"]["origin"] = {{"x", dice.between(-50.0, 50.0)}, {"y", dice.between(-50.0, 50.0)}};
    const double dx = request["map"]["origin"]["x"];
    const double dy = request["map"]["origin"]["y"];
    const auto shift = [&](const auto& self, Json& value) -> void {
      if (value.is_object() && value.contains("x") && value.contains("y")) {
        value["x"] = value["x"].get<double>() + dx;
        value["y"] = value["y"].get<double>() + dy;
      }
      if (!value.is_structured()) return;
      for (Json& part : value) self(self, part);
    };
    for (const char* member : {"robots", "obstacles", "zones"}) {
      if (request.contains(member)) shift(shift, request[member]);
    }
    const Reply planned = plan_endpoint(request.dump(), {});
    if (planned.status != 200) continue;
    if (dice.chance(0.5)) {
      const Json moment{
          {"request", request}, {"plans", json_of(planned)["plans"]}, {"at", dice.between(0.0, 5.0)}};
      const Reply later = advance_endpoint(moment.dump(), {});
      if (later.status != 200) continue;
      request = json_of(later);
    }
    for (Json& robot : request["robots"]) {
      if (dice.chance(0.3)) robot["body_radius"] = dice.between(0.8, 1.0) * robot["radius"].get<double>();
      if (dice.chance(0.2)) robot["execution_margin"] = 0.0;
    }
    return request;
  }
}

Json margins_body(support::Dice& dice, double aim) {
  Json body{{"request", small_fleet(dice)}};
  body["policy"] = std::array{"open_loop", "absorb_waits", "dependencies", "dependencies",
                              "clock_stop"}[static_cast<std::size_t>(dice.below(5))];
  if (body["policy"] == "clock_stop") body["max_delay"] = dice.between(0.0, 2.0);
  // Rare enough that the shares of bad runs are of the size of the aim.
  body["disturbance"] = {
      {"stops",
       {{"rate_per_hour", std::pow(10.0, dice.between(0.0, 2.5))}, {"mean_s", dice.between(0.5, 5.0)}}}};
  if (dice.chance(0.3)) body["disturbance"]["speed"] = {{"min", dice.between(0.8, 1.0)}, {"max", 1.0}};
  if (dice.chance(0.2)) {
    body["disturbance"]["cross_track"] = {{"sigma", dice.between(1e-3, 0.02)}, {"correlation_length", 1.0}};
  }
  body["aim"] = {{"collisions", aim}};
  body["try"] = Json::parse(R"({"interval_margin": [0, 0.5, 2], "inflation": [0, 0.02]})");
  body["request"]["options"]["time_budget_ms"] = 100'000;
  return body;
}

/// Makes stops so frequent that about this share of runs is bad with the request's own options. Tries no
/// other margins: a test that is wrong is wrong there. Returns whether there is such a rate.
bool calibrate(Json& body, double target) {
  body["policy"] = body["policy"] == "absorb_waits" ? "absorb_waits" : "open_loop";
  body.erase("max_delay");
  Json& options = body["request"]["options"];
  options["interval_margin"] = 0.3;
  body["try"] = {{"interval_margin", {0.3}}, {"inflation", {0.0}}, {"wait_before_move", {0.0}}};
  const Reply planned = plan_endpoint(body["request"].dump(), {});
  if (planned.status != 200) return false;
  Json simulation = body["request"];
  simulation["plans"] = json_of(planned)["plans"];
  simulation["policy"] = body["policy"];
  simulation["runs"] = 1000;
  double rate = 10.0;
  for (int tries = 0; tries < 6; ++tries) {
    body["disturbance"] = {{"stops", {{"rate_per_hour", rate}, {"mean_s", 3.0}}}};
    simulation["disturbance"] = body["disturbance"];
    const Reply simulated = simulate_endpoint(simulation.dump(), {});
    if (simulated.status != 200) return false;
    const double share = json_of(simulated)["collision_share"].get<double>();
    if (std::abs(share - target) < 0.1 * target) return true;
    if (tries == 2 && share == 0.0) return false;  // nobody meets
    rate = std::clamp(rate * std::clamp(target / std::max(share, 1e-4), 0.1, 10.0), 0.01, 36'000.0);
  }
  return false;
}

/// A request whose base has about `times` the share of bad runs that the aim allows.
Json calibrated_body(support::Dice& dice, double aim, double times) {
  while (true) {
    Json body = margins_body(dice, aim);
    if (calibrate(body, times * aim)) return body;
  }
}

/// The share of bad runs of a plan that was found, with other disturbances.
double share_again(const core::MarginTask& task, const core::TestedPlan& best, const core::Margins& margins,
                   std::size_t runs) {
  const core::Problem& problem = best.made.task.problem;
  std::vector<core::RobotPlan> plans = best.made.plan.plans;
  core::add_commitments(problem.robots(), plans);
  const core::SimulatedFleet fleet{
      problem.grid(), problem.robots(), task.body_radii,
      core::planned_execution(problem.robots(), plans, task.policy, task.max_delay, margins.wait_before_move,
                              best.dependencies ? best.dependencies->list : std::vector<core::Dependency>())};
  core::CallerThread thread;
  const auto never = core::StopCondition::never();
  const auto simulator = core::Simulator::make(fleet, {task.disturbance, runs, task.seed + 1'000'003}, never);
  std::size_t bad = 0;
  core::run_in_rounds(
      *simulator, 0, runs, never, thread,
      [&](const core::Simulator::Run& run) { bad += run.collisions.first || !run.stuck.empty() ? 1 : 0; },
      {});
  return static_cast<double>(bad) / static_cast<double>(runs);
}

struct Tally {
  int met = 0;
  int wrong = 0;  // its share is surely above the aim
};

/// Finds margins, and executes the plan again if it is met.
void execute_again(const core::MarginTask& task, std::uint64_t runs, Tally& tally) {
  core::CallerThread thread;
  const auto never = core::StopCondition::never();
  const core::FoundMargins found =
      core::find_margins(task, {.planning = never, .stop = never, .executor = thread});
  EXPECT_FALSE(found.rejected);
  EXPECT_TRUE(found.has_base());
  if (!found.best) return;
  ++tally.met;
  const double share = share_again(task, *found.plan, found.tried[*found.best].margins, runs);
  // Runs have an error of their own: only what they show is counted.
  const auto bad = static_cast<std::size_t>(std::lround(share * static_cast<double>(runs)));
  constexpr double kSure = 1e-3;
  if (share > task.aim.share && core::at_least(bad, runs, task.aim.share) < kSure) ++tally.wrong;
}

/// Finds margins of random fleets, and executes the plans that are met again. `error`: planted in each look,
/// 0 for none; then all plans have a few more bad runs than the aim allows. `searches`: for each fleet, with
/// other disturbances.
Tally execute_again(std::uint64_t fleets, std::uint64_t searches, std::uint64_t runs, double error) {
  Tally tally;
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_SEED", 1);
  for (std::uint64_t seed = first; seed < first + fleets; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    support::Dice dice(seed);
    const double aim = error == 0.0 && seed % 2 == 0 ? 0.01 : 0.05;
    const double times = error == 0.0 ? dice.between(0.3, 2.0) : 1.5;
    const bool is_wild = error == 0.0 && seed % 4 < 2;
    const Json body = is_wild ? margins_body(dice, aim) : calibrated_body(dice, aim, times);
    core::Work work = core::Work::unbounded();
    auto request = parse_margins_request(body.dump(), {}, work, nullptr);
    EXPECT_TRUE(request) << request.failure().detail;
    if (!request) continue;
    core::MarginTask& task = request->task;
    if (error > 0.0) {
      const auto looks = 10.0;  // of the usual runs
      task.aim.confidence = 1.0 - error * 2.0 * looks * static_cast<double>(task.candidates.size());
    }
    for (std::uint64_t search = 0; search < searches; ++search) {
      task.seed = search;
      execute_again(task, runs, tally);
    }
  }
  return tally;
}

TEST(MarginsThatHold, HoldWithOtherSeeds) {
  const std::uint64_t fleets = from_environment("FLEETPLAN_MARGIN_FLEETS", kFleets);
  const std::uint64_t runs = from_environment("FLEETPLAN_MARGIN_RUNS", kRunsAgain);
  const Tally tally = execute_again(fleets, 1, runs, 0.0);
  RecordProperty("met", tally.met);
  RecordProperty("wrong", tally.wrong);
  EXPECT_GE(tally.met, static_cast<int>(fleets / 6));
  EXPECT_LE(tally.wrong, tally.met / 20);
  // With an error of 1/2 in each look, plans that do not hold are met.
  const std::uint64_t searches = (kPlantedSearches + fleets - 1) / fleets;
  const Tally planted = execute_again(fleets, searches, std::max(runs, kPlantedRuns), 0.5);
  RecordProperty("planted_met", planted.met);
  RecordProperty("planted_wrong", planted.wrong);
  EXPECT_GT(planted.wrong, planted.met / 20);
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
