// Requests that are moved in the world get the same answers, moved. They are equal to the last digit if the
// move loses no digit of the request.

#include "tests/api/support/moved.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "api/endpoints/endpoints.h"
#include "api/request/parse_request.h"
#include "tests/api/support/lives.h"
#include "tests/soak/lives/tight_fleets.h"

namespace fleetplan::api {
namespace TEST_FILE {

constexpr double kSame = 1e-6;

/// Metres: multiples of 2^-10 lose no digit of positions that are multiples of 2^-20.
struct Shift {
  double x;
  double y;
};

/// Whether moving and moving back gives every position of the JSON.
bool loses_nothing(const Json& json, const Shift& by) {
  return moved(moved(json, by.x, by.y), -by.x, -by.y) == moved(json, 0.0, 0.0);
}

/// Without what differs from answer to answer.
Json lasting(Json answer) {
  for (const char* member : {"timings_ms", "request_id", "search"}) answer.erase(member);
  return answer;
}

/// Whether two answers are the same, except for rounding of their numbers.
bool are_near(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) {
    const double x = a.get<double>();
    const double y = b.get<double>();
    return std::abs(x - y) <= kSame * std::max(1.0, std::abs(x));
  }
  if (a.type() != b.type() || a.size() != b.size()) return false;
  if (a.is_array()) return std::equal(a.begin(), a.end(), b.begin(), are_near);
  if (!a.is_object()) return a == b;
  for (const auto& [key, value] : a.items()) {
    if (!b.contains(key) || !are_near(value, b.at(key))) return false;
  }
  return true;
}

/// What an answer comes to: its verdicts, costs and objectives. Ties are decided by rounding, so that the
/// rest may differ.
Json outcome(const Json& answer) {
  Json found = Json::object();
  for (const char* member : {"status", "valid", "verified", "flowtime", "makespan"}) {
    if (answer.contains(member)) found[member] = answer.at(member);
  }
  for (const Json& plan : answer.value("plans", Json::array())) {
    if (plan.contains("cost")) found["costs"].push_back(plan.at("cost"));
  }
  return found;
}

using Endpoint = std::function<Reply(const Json&)>;

Reply planned(const Json& request) { return planned_in(5'000, request); }

/// Which answers are to be the same, moved.
enum class Digits { all, most };

/// Sends a request and the same one moved, and returns the answer to the first.
Json expect_moved(const char* name, const Endpoint& endpoint, const Json& body, const Shift& by,
                  Digits digits = Digits::all) {
  const Json other = moved(body, by.x, by.y);
  const Reply reply = endpoint(body);
  const Reply moved_reply = endpoint(other);
  EXPECT_EQ(reply.status, moved_reply.status) << name << '\n' << body << '\n' << moved_reply.body;
  if (reply.status != 200 || moved_reply.status != 200) return nullptr;
  Json answer = Json::parse(reply.body);
  const Json expected = lasting(moved(answer, by.x, by.y));
  const Json found = lasting(Json::parse(moved_reply.body));
  if (digits == Digits::most) {
    // Moved back, where rounding is least.
    EXPECT_TRUE(are_near(moved(found, -by.x, -by.y), lasting(answer))) << name << '\n' << body;
  } else if (loses_nothing(body, by)) {
    EXPECT_EQ(found, expected) << name << " by " << by.x << ' ' << by.y << '\n' << body;
  } else {
    EXPECT_TRUE(are_near(outcome(found), outcome(expected))) << name << '\n'
                                                             << body << '\n'
                                                             << found << '\n'
                                                             << expected;
  }
  return answer;
}

/// What happens at a moment of the plans.
Json advance_body(Dice& dice, const Json& request, const Json& answer) {
  const double at = dice.between(0.0, 0.6 * answer.at("makespan").get<double>() + 1.0);
  Json plans = answer.at("plans");
  for (Json& plan : plans) {
    if (dice.chance(0.2)) plan.erase("visits");
  }
  Json body{{"request", request}, {"plans", plans}, {"at", at}};
  if (dice.chance(0.6)) body["commit"] = dice.between(0.0, 12.0);
  for (Json& plan : plans) {
    if (dice.chance(0.2)) body["holds"].push_back({{"robot", plan["robot"]}, {"until", 3.0}});
    const auto under = under_way(plan.at("actions"), at);
    if (under && dice.chance(0.2)) {
      body["states"].push_back(
          {{"robot", plan["robot"]}, {"action", under->action}, {"progress", under->progress}});
    } else if (under && dice.chance(0.2)) {
      const auto dyadic = [](double x) { return std::round(x * 1024.0) / 1024.0; };
      body["poses"].push_back({{"robot", plan["robot"]},
                               {"x", dyadic(under->pose.position.x())},
                               {"y", dyadic(under->pose.position.y())},
                               {"theta", under->pose.theta}});
    }
  }
  return body;
}

void expect_all_moved(Dice& dice, const Json& request, const Shift& by) {
  const Json answer = expect_moved("plan", planned, request, by);
  if (answer.is_null()) return;
  const auto of = [](Reply (*endpoint)(std::string_view, const RequestContext&)) {
    return [endpoint](const Json& body) { return endpoint(body.dump(), {}); };
  };
  Json whole = request;
  whole.update(answer);
  expect_moved("validate", of(validate_endpoint), whole, by);
  const Json advanced =
      expect_moved("advance", of(advance_endpoint), advance_body(dice, request, answer), by);
  if (!advanced.is_null()) expect_moved("plan again", planned, advanced, by);

  Json executed = request;
  executed["plans"] = answer.at("plans");
  if (answer.contains("unavoidable")) return;
  const Json dependencies = expect_moved("dependencies", of(dependencies_endpoint), executed, by);
  Json simulated = executed;
  simulated["policy"] = "open_loop";
  simulated["runs"] = 3;
  simulated["disturbance"] = {{"start_delay", {{"min", 0.0}, {"max", 0.5}}}};
  expect_moved("simulate", of(simulate_endpoint), simulated, by);
  if (dependencies.is_null()) return;
  executed["dependencies"] = dependencies.at("dependencies");
  executed["version"] = dice.chance(0.5) ? "2.1.0" : "3.0.0";
  executed["manufacturer"] = "acme";
  executed["timestamp"] = "2026-01-31T12:00:00.000Z";
  executed["map_id"] = "hall";
  if (dice.chance(0.5)) executed["release_ahead"] = dice.between(1.0, 20.0);
  // Orders have places within moves, which are computed in the world.
  expect_moved("export", of(vda5050_endpoint), executed, by, Digits::most);
  Json retimed{{"robots", request.at("robots")},
               {"plans", answer.at("plans")},
               {"dependencies", dependencies.at("dependencies")},
               {"at", 1.0},
               {"states", Json::array()}};
  expect_moved("retime", of(retime_endpoint), retimed, by);
}

void expect_travel_moved(Dice& dice, TightFleet& fleet, const Json& request, const Shift& by) {
  const auto of = [](Reply (*endpoint)(std::string_view, const RequestContext&)) {
    return [endpoint](const Json& body) { return endpoint(body.dump(), {}); };
  };
  Json matrix{{"map", request.at("map")},
              {"robot", {{"radius", 0.3}, {"linear_speed", 1.0}, {"angular_speed", 2.0}}},
              {"from", Json::array({fleet.cell(), fleet.cell()})},
              {"to", Json::array({fleet.cell(), fleet.cell(), fleet.cell()})}};
  expect_moved("matrix", of(matrix_endpoint), matrix, by);
  Json tasks = Json::array();
  for (int k = 1 + dice.below(2); k > 0; --k) {
    tasks.push_back({{"id", "t" + std::to_string(k)}, {"goals", Json::array({fleet.cell()})}});
  }
  expect_moved("assign", of(assign_endpoint), Json{{"request", request}, {"tasks", tasks}}, by);
}

TEST(MovedRequests, GetTheSameAnswersMoved) {
  const std::uint64_t lives = from_environment("FLEETPLAN_MOVED", 60);
  for (std::uint64_t seed = 0; seed < lives; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    TightFleet fleet(dice);
    Json request = full_request(dice, fleet);
    add_more(dice, request);
    request["options"]["smoothing"] = false;  // bends lie anywhere, so moving them loses digits
    if (!parse_request(request.dump(), {}, unbounded_work())) continue;
    const double most = std::pow(2.0, 10 + dice.below(20));
    const auto shift = [&] { return std::round(dice.between(-most, most)) / 1024.0; };
    const bool is_any = dice.chance(0.3);
    const Shift by =
        is_any ? Shift{dice.between(-500.0, 500.0), dice.between(-500.0, 500.0)} : Shift{shift(), shift()};
    expect_all_moved(dice, request, by);
    expect_travel_moved(dice, fleet, request, by);
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
