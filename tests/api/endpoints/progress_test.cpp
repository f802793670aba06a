// Random well-formed fleets in the loop of docs/fleet_loop.md, with a horizon. Every goal is served within a
// number of rounds, whatever robots are held, late or beside their paths. There is no number of rounds in
// which no robot serves a goal. Well-formed: each robot has a way between any two of its places past all
// other robots that stand at theirs.
//
// FLEETPLAN_ROUNDS is how often they are planned in all, FLEETPLAN_FIRST_LIFE the seed of the first fleet.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/fleet_json.h"
#include "tests/api/support/lives.h"
#include "tests/support/sanitized.h"

namespace fleetplan::api {
namespace TEST_FILE {

using core::Cell;
using core::OccupancyGrid;
using support::Dice;

constexpr int kRoundsOfALife = 150;
/// A service, a hold, and rounds in which a goal is given.
constexpr double kFewRounds = 10.0;
/// Far more than the searches of these fleets need.
constexpr std::int64_t kPlenty = 200'000;

/// The cells of a map that are free for ways, and the cells of robots.
class Floor {
 public:
  Floor(Dice& dice, OccupancyGrid grid) : grid_(std::move(grid)), is_road_(count(), 0) {
    for (std::size_t cell = 0; cell < count(); ++cell) is_road_[cell] = grid_.blocked(at(cell)) ? 0 : 1;
    keep_one_part(dice);
  }

  /// A cell without which the rest of the road is connected, next to it, and next to each place.
  std::optional<Cell> take_place(Dice& dice) {
    constexpr int kAttempts = 40;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto cell = static_cast<std::size_t>(dice.below(static_cast<int>(count())));
      if (is_road_[cell] == 0) continue;
      is_road_[cell] = 0;
      places_.push_back(cell);
      const bool all_reached = std::all_of(places_.begin(), places_.end(),
                                           [&](std::size_t place) { return !road_beside(place).empty(); });
      if (all_reached && is_connected()) return at(cell);
      places_.pop_back();
      is_road_[cell] = 1;
    }
    return std::nullopt;
  }

  const OccupancyGrid& grid() const { return grid_; }

 private:
  std::size_t count() const { return static_cast<std::size_t>(grid_.columns() * grid_.rows()); }
  Cell at(std::size_t cell) const {
    const int index = static_cast<int>(cell);
    return {index % grid_.columns(), index / grid_.columns()};
  }

  std::vector<std::size_t> road_beside(std::size_t cell) const {
    const auto [column, row] = at(cell);
    std::vector<std::size_t> beside;
    for (const Cell next :
         {Cell{column + 1, row}, Cell{column - 1, row}, Cell{column, row + 1}, Cell{column, row - 1}}) {
      if (next.column < 0 || next.row < 0 || next.column >= grid_.columns() || next.row >= grid_.rows())
        continue;
      const auto index = static_cast<std::size_t>(next.row * grid_.columns() + next.column);
      if (is_road_[index] != 0) beside.push_back(index);
    }
    return beside;
  }

  std::vector<char> reached_from(std::size_t cell) const {
    std::vector<char> reached(count(), 0);
    std::vector<std::size_t> next{cell};
    reached[cell] = 1;
    while (!next.empty()) {
      const std::size_t here = next.back();
      next.pop_back();
      for (const std::size_t beside : road_beside(here)) {
        if (std::exchange(reached[beside], 1) == 0) next.push_back(beside);
      }
    }
    return reached;
  }

  bool is_connected() const {
    const auto first = std::find(is_road_.begin(), is_road_.end(), 1);
    return first != is_road_.end() &&
           reached_from(static_cast<std::size_t>(first - is_road_.begin())) == is_road_;
  }

  /// Whatever is not connected with one cell is blocked.
  void keep_one_part(Dice& dice) {
    std::size_t cell = static_cast<std::size_t>(dice.below(static_cast<int>(count())));
    while (is_road_[cell] == 0) cell = (cell + 1) % count();
    is_road_ = reached_from(cell);
    for (std::size_t other = 0; other < count(); ++other) {
      if (is_road_[other] == 0) grid_.block(at(other));
    }
  }

  OccupancyGrid grid_;
  std::vector<char> is_road_;
  std::vector<std::size_t> places_;
};

/// Halls with pillars, and mazes of passages for one robot.
OccupancyGrid random_floor(Dice& dice) {
  OccupancyGrid grid(6 + dice.below(9), 5 + dice.below(8), 1.0);
  const double density = dice.chance(0.2) ? 0.0 : dice.between(0.1, 0.45);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      if (dice.chance(density) && (row > 0 || column > 0)) grid.block({column, row});
    }
  }
  return grid;
}

Json zones_for(Dice& dice, const OccupancyGrid& grid) {
  Json zones = Json::array();
  if (!dice.chance(0.3)) return zones;
  const double x = dice.between(0.0, grid.width());
  const double y = dice.between(0.0, grid.height());
  Json zone{{"id", "slow"}, {"type", "speed"}, {"linear_speed", dice.between(0.2, 1.0)}, {"polygon", {}}};
  for (const auto& [dx, dy] : {std::pair(0.0, 0.0), {3.0, 0.0}, {3.0, 2.0}, {0.0, 2.0}}) {
    zone["polygon"].push_back(json_of(core::Position(x + dx, y + dy)));
  }
  zones.push_back(std::move(zone));
  return zones;
}

/// A fleet whose robots go back and forth between their places, from round to round.
class Life {
 public:
  explicit Life(Dice& dice) : dice_(dice) {
    while (places_.size() < 2) found_fleet();
  }

  std::size_t robots() const { return places_.size(); }

  /// Returns false if a request is refused.
  bool go_on() {
    const Reply planned = planned_in(kPlenty, request_);
    EXPECT_EQ(planned.status, 200) << planned.body << "\n" << request_;
    if (planned.status != 200) return false;
    const Json answer = Json::parse(planned.body);
    const Json body = observed(answer);
    const Reply advanced = advance_endpoint(body.dump(), {});
    EXPECT_EQ(advanced.status, 200) << advanced.body << "\n" << body;
    if (advanced.status != 200) return false;
    request_ = Json::parse(advanced.body);
    for (Json& robot : request_.at("robots")) count_round(robot);
    ++idle_rounds_;
    return true;
  }

  int rounds_without_service() const { return idle_rounds_; }
  int longest_wait() const {
    int longest = 0;
    for (const auto& [id, rounds] : rounds_) longest = std::max(longest, rounds);
    return longest;
  }
  /// Rounds in which the slowest robot crosses all of the map.
  double rounds_of_a_way() const { return way_ / period_; }
  std::string text() const { return request_.dump(); }

 private:
  void found_fleet() {
    Floor floor(dice_, random_floor(dice_));
    places_.clear();
    has_holds_ = dice_.chance(0.6);
    const int most = 2 + dice_.below(12);
    for (int k = 0; k < most; ++k) {
      std::vector<core::Position> own;
      for (int place = 0; place < 3; ++place) {
        if (const auto cell = floor.take_place(dice_)) own.push_back(floor.grid().center(*cell));
      }
      if (own.size() >= 2) places_["r" + std::to_string(k)] = own;
    }
    request_ = Json{{"map", json_of(floor.grid())}, {"robots", Json::array()}};
    double slowest = 1.0;
    for (const auto& [id, own] : places_) {
      const double speed = dice_.chance(0.5) ? 1.0 : dice_.between(0.4, 2.0);
      slowest = std::min(slowest, speed);
      request_["robots"].push_back({{"id", id},
                                    {"radius", dice_.between(0.15, 0.42)},
                                    {"linear_speed", speed},
                                    {"angular_speed", dice_.between(1.0, 6.0)},
                                    {"may_reverse", dice_.chance(0.2)},
                                    {"start", json_of(own.front())}});
      if (!has_holds_ && dice_.chance(0.3)) {
        request_["robots"].back()["stop_distance"] = dice_.between(0.0, 0.5);
      }
      request_["robots"].back()["goals"] = new_goals(id, own.front());
    }
    request_["zones"] = zones_for(dice_, floor.grid());
    const double horizon = dice_.between(3.0, 20.0);
    period_ = horizon * dice_.between(0.15, 0.5);
    way_ = 2.0 * (floor.grid().width() + floor.grid().height()) / slowest;
    request_["options"] = {{"horizon", horizon},
                           {"time_budget_ms", 100'000},
                           {"invalid_robots", "report"},
                           {"start_overlap", 0.15}};
    if (dice_.chance(0.5)) request_["options"]["inflation"] = 0.05;
    if (dice_.chance(0.5)) request_["options"]["interval_margin"] = dice_.between(0.1, 1.0);
  }

  Json new_goals(const std::string& id, const core::Position& from) {
    const std::vector<core::Position>& own = places_.at(id);
    Json goals = Json::array();
    core::Position last = from;
    for (int k = dice_.chance(0.3) ? 2 : 1; k > 0; --k) {
      core::Position to = last;
      while ((to - last).norm() < 0.5)
        to = own[static_cast<std::size_t>(dice_.below(static_cast<int>(own.size())))];
      last = to;
      goals.push_back(json_of(to));
      if (dice_.chance(0.5)) goals.back()["service"] = dice_.between(0.0, 4.0);
    }
    return goals;
  }

  /// What happens to the plans in a round.
  Json observed(const Json& answer) {
    Json body{{"request", request_}, {"plans", answer.at("plans")}, {"at", period_}, {"pose_tolerance", 0.1}};
    if (dice_.chance(0.8)) body["commit"] = period_ * dice_.between(0.0, 1.0);
    for (const Json& plan : answer.at("plans")) {
      if (has_holds_ && dice_.chance(0.03)) {
        body["holds"].push_back({{"robot", plan.at("robot")}, {"until", dice_.between(0.0, 10.0)}});
      }
      if (dice_.chance(0.2)) observe(body, plan);
    }
    return body;
  }

  /// The robot is late, and a little beside its path, by no more than its plan allows for.
  void observe(Json& body, const Json& plan) {
    const double late = dice_.between(0.0, 0.5 * request_.at("options").value("interval_margin", 0.0));
    const auto under = under_way(plan.at("actions"), period_ - late);
    if (!under) return;
    const auto off = [&] { return dice_.between(-0.02, 0.02); };
    Json state{{"robot", plan.at("robot")}, {"action", under->action}, {"progress", under->progress}};
    if (request_.at("options").contains("inflation") && dice_.chance(0.5)) {
      state["x"] = under->pose.position.x() + off();
      state["y"] = under->pose.position.y() + off();
    }
    body["states"].push_back(std::move(state));
  }

  /// Another round for the goal of a robot; new goals if it has served all.
  void count_round(Json& robot) {
    const std::string id = robot.at("id");
    const Json& goals = robot.at("goals");
    const auto left = static_cast<int>(goals.size());
    const Json& last = goals.at(goals.size() - 1);
    const core::Position start(robot.at("start").at("x"), robot.at("start").at("y"));
    const core::Position goal(last.at("x"), last.at("y"));
    const bool is_served = left == 1 && !last.contains("service") && (start - goal).norm() < 1e-6;
    const bool gains = is_served || std::exchange(left_[id], left) > left;
    ++rounds_[id];
    if (!gains) return;
    rounds_[id] = idle_rounds_ = 0;
    if (!is_served) return;
    robot["goals"] = new_goals(id, start);
    left_[id] = static_cast<int>(robot["goals"].size());
    robot.erase("previous");
  }

  Dice& dice_;
  std::map<std::string, std::vector<core::Position>> places_;  // by robot
  Json request_;
  bool has_holds_ = false;  // otherwise, robots that cannot stop at once: they run into robots that stop
                            // before them
  double period_ = 1.0;     // seconds
  double way_ = 0.0;        // seconds
  std::map<std::string, int> rounds_;  // since the robot has served a goal, or had none
  std::map<std::string, int> left_;    // goals
  int idle_rounds_ = 0;                // since any robot has served a goal
};

TEST(Progress, EveryGoalOfAWellFormedFleetIsServed) {
  const std::uint64_t first = from_environment("FLEETPLAN_FIRST_LIFE", 0);
  const std::uint64_t rounds = from_environment("FLEETPLAN_ROUNDS", support::kSanitized ? 450 : 1500);
  std::uint64_t done = 0;
  for (std::uint64_t seed = first; done < rounds; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dice dice(seed);
    Life life(dice);
    const double way = life.rounds_of_a_way();
    for (int round = 0; round < kRoundsOfALife; ++round, ++done) {
      if (!life.go_on()) return;
      ASSERT_LE(life.longest_wait(), kFewRounds + way * static_cast<double>(life.robots())) << life.text();
      ASSERT_LE(life.rounds_without_service(), kFewRounds + way) << life.text();
    }
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
