#include "tests/fuzz/effort_requests.h"

#include <fleetplan/limits.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/request/limits.h"
#include "tests/fuzz/effort_members.h"
#include "tests/support/base64.h"

namespace fleetplan::fuzz {

namespace {

using Json = nlohmann::json;

constexpr double kLeastRadius = 1e-4;  // of the API, metres

template <typename Number>
std::string name_of(char letter, Number number) {
  return std::string(1, letter).append(std::to_string(number));
}

/// Rows of free cells with walls that leave gaps.
Json rows_of(int columns, int rows, Choices& choices) {
  const int wall_every = 2 + choices.up_to(60);
  const int gap = 1 + choices.up_to(20);
  const bool has_walls = choices.yes();
  Json lines = Json::array();
  for (int row = 0; row < rows; ++row) {
    std::string line(static_cast<std::size_t>(columns), '.');
    if (has_walls && row % wall_every == wall_every - 1) {
      for (int column = 0; column < columns; ++column) {
        if ((column + row / wall_every) % (4 * gap) >= gap) line[static_cast<std::size_t>(column)] = '#';
      }
    }
    lines.push_back(line);
  }
  return lines;
}

/// The centres of every so many free cells.
std::vector<Json> places_of(const Json& lines, int distance, double resolution) {
  std::vector<Json> places;
  const int rows = static_cast<int>(lines.size());
  for (int row = 0; row < rows; row += distance) {
    const auto& line = lines[static_cast<std::size_t>(row)].get_ref<const std::string&>();
    for (int column = 0; column < static_cast<int>(line.size()); column += distance) {
      if (line[static_cast<std::size_t>(column)] == '#') continue;
      places.push_back({{"x", (column + 0.5) * resolution}, {"y", (rows - row - 0.5) * resolution}});
    }
  }
  return places;
}

/// Robots at a distance from each other. The goal of each is the start of another robot, or a place further
/// on.
Json robots_of(int count, const Json& lines, double resolution, Choices& choices) {
  const std::vector<Json> places = places_of(lines, 1 + choices.up_to(20), resolution);
  const int most = static_cast<int>(places.size());
  const int shift = choices.up_to(most);
  const int parked_every = 1 + choices.byte();
  const std::string padding(choices.one_of(std::array<std::size_t, 3>{0, 30, 250}), 'x');
  Json robots = Json::array();
  for (int k = 0; k < std::min(count, most); ++k) {
    Json robot{{"id", std::to_string(k) + padding}, {"start", places[static_cast<std::size_t>(k)]}};
    if (k % parked_every != parked_every - 1) {
      robot["goal"] = places[static_cast<std::size_t>((k + shift) % most)];
    }
    robots.push_back(robot);
  }
  return robots;
}

/// The extent of a map, metres.
struct Extent {
  double width;
  double height;
};

Extent extent_of(const Json& map) {
  const double resolution = map.value("resolution", 1.0);
  return {resolution * static_cast<double>(map["rows"][0].get_ref<const std::string&>().size()),
          resolution * static_cast<double>(map["rows"].size())};
}

/// A star with so many corners, which may leave the map.
Json star(double x, double y, double radius, int corners) {
  Json polygon = Json::array();
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / corners;
    const double reach = k % 2 == 0 ? radius : 0.4 * radius;
    polygon.push_back({{"x", x + reach * std::cos(angle)}, {"y", y + reach * std::sin(angle)}});
  }
  return polygon;
}

/// A zone with a mask for this map: squares of cells, of some values in turn.
Json mask_for(const Json& map, Choices& choices) {
  const std::size_t rows = map["rows"].size();
  const std::size_t columns = map["rows"][0].get_ref<const std::string&>().size();
  const auto side = static_cast<std::size_t>(1 + choices.up_to(30));
  const int values = 2 + choices.up_to(98);
  std::string pixels;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      pixels += static_cast<char>((column / side + 7 * (row / side)) % static_cast<std::size_t>(values));
    }
  }
  const double size = map.value("resolution", 1.0);
  Json mask{{"mode", choices.one_of(std::array{"raw", "scale"})}};
  if (choices.yes()) mask.update({{"resolution", 0.7 * size}, {"origin", {size, -size, 1.5708}}});
  const std::string header = "P5 " + std::to_string(columns) + " " + std::to_string(rows) + " 255\n";
  mask["pgm"] = support::base64(header + pixels);
  return {
      {"id", "mask"}, {"type", choices.one_of(std::array{"blocked", "speed"})}, {"mask", std::move(mask)}};
}

Json zones_of(const Json& map, const Extent& extent, Choices& choices) {
  Json zones = Json::array();
  if (choices.yes()) zones.push_back(mask_for(map, choices));
  const int count = choices.up_to(200);
  const int corners = 4 + 2 * choices.up_to(40);
  const double size = std::min(extent.width, extent.height) * (0.01 + choices.up_to(100) / 100.0);
  for (int k = 0; k < count; ++k) {
    const double x = extent.width * std::fmod(0.618 * k + 0.3, 1.0);
    const double y = extent.height * std::fmod(0.414 * k + 0.7, 1.0);
    Json zone{{"id", name_of('z', k)}, {"polygon", star(x, y, size, corners)}};
    zone["type"] = choices.one_of(std::array{"blocked", "speed", "one_way"});
    if (zone["type"] == "speed") zone["linear_speed"] = choices.one_of(std::array{1e-3, 0.5, 1e3});
    if (zone["type"] == "one_way") zone.update({{"heading", 0.5 * k}, {"half_angle", 1.0}});
    if (zone["type"] == "blocked" && k % 2 == 1) zone["enter"] = false;
    zones.push_back(std::move(zone));
  }
  return zones;
}

Json obstacles_of(const Extent& extent, Choices& choices) {
  Json obstacles = Json::array();
  const int count = choices.up_to(300);
  const int entries = 1 + choices.up_to(150);
  const double radius = std::max(
      kLeastRadius, std::min(extent.width, extent.height) * choices.one_of(std::array{1e-3, 0.1, 1.0}));
  for (int k = 0; k < count; ++k) {
    Json motion = Json::array();
    for (int entry = 0; entry < entries; ++entry) {
      motion.push_back({{"t", 1e3 * entry},
                        {"x", extent.width * std::fmod(0.618 * (k + entry), 1.0)},
                        {"y", extent.height * std::fmod(0.414 * (k - entry) + 100.0, 1.0)}});
    }
    obstacles.push_back({{"id", name_of('o', k)}, {"radius", radius}, {"motion", std::move(motion)}});
  }
  return obstacles;
}

/// Robots from this one on all have the same goal, or a goal near it.
void add_tolerances(Json& robots, std::size_t first) {
  for (std::size_t k = first; k < robots.size(); ++k) {
    if (robots[k].contains("goal")) robots[k]["goal"] = robots[k]["start"];
    if (robots[k].contains("goal")) robots[k]["goal"].update({{"tolerance", 1.0}, {"x", 0.5}, {"y", 0.5}});
  }
}

/// Goals that are served at one of the starts of robots, as many as there may be. All goals have all starts,
/// or each goal has others.
void add_open_goals(Json& robots, Choices& choices) {
  constexpr std::size_t kMaxRobots = 190;  // with all poses within max_goals
  const std::size_t poses = std::min(robots.size(), 2 + static_cast<std::size_t>(choices.up_to(98)));
  if (poses < 2) return;
  const bool are_own = choices.yes();
  for (std::size_t k = 0; k < robots.size() && k < kMaxRobots; ++k) {
    if (!robots[k].contains("goal")) continue;
    Json any_of = Json::array();
    for (std::size_t pose = 0; pose < std::min(poses, kMaxPoses); ++pose) {
      any_of.push_back(robots[(7 * pose + (are_own ? k : 0)) % robots.size()]["start"]);
    }
    for (const char* member : {"x", "y", "theta"}) robots[k]["goal"].erase(member);
    robots[k]["goal"]["any_of"] = std::move(any_of);
    robots[k]["idle"] = k < poses / 2 ? "stay" : "yield";
  }
  add_tolerances(robots, kMaxRobots);
}

/// Members that a request of POST /v1/plan may have besides.
void add_members(Json& request, Choices& choices) {
  const Extent extent = extent_of(request["map"]);
  if (choices.yes()) request["zones"] = zones_of(request["map"], extent, choices);
  if (choices.yes()) request["obstacles"] = obstacles_of(extent, choices);
  Json& options = request["options"];
  if (choices.yes()) options["horizon"] = choices.one_of(std::array{0.1, 10.0, 1e3});
  if (choices.yes()) options["start_overlap"] = choices.one_of(std::array{0.01, 1.0, 1e6});
  if (choices.yes()) options["goal_overlap"] = choices.one_of(std::array{0.01, 1.0, 1e6});
  if (choices.yes()) options["interval_margin"] = choices.one_of(std::array{0.01, 1.0, 100.0});
  if (choices.yes()) options["dependencies"] = true;
  if (choices.yes()) request["robot_defaults"]["vicinity"] = choices.one_of(std::array{0.01, 5.0, 1e3});
  if (choices.yes()) request["robot_defaults"]["may_reverse"] = true;
  const int goals = choices.up_to(200);
  Json& robots = request["robots"];
  if (options.contains("horizon")) robots[0]["goal_age"] = 60.0;
  const int idle = choices.up_to(3);
  for (std::size_t k = 0; idle > 0 && k < robots.size(); k += 1 + static_cast<std::size_t>(idle)) {
    robots[k]["idle"] = choices.one_of(std::array{"stay", "yield", "return"});
    if (choices.yes()) robots[k].erase("goal");
  }
  const bool are_due = choices.yes();
  if (are_due) options["objective"] = "tardiness";
  for (std::size_t k = 0; are_due && k < robots.size(); ++k) {
    robots[k]["weight"] = choices.one_of(std::array{0.001, 1.0, 1000.0});
    if (robots[k].contains("goal")) robots[k]["goal"]["due"] = -10.0 + static_cast<double>(k % 100);
  }
  for (std::size_t k = 0; goals > 0 && k < robots.size() && k < 100; ++k) {
    if (!robots[k].contains("goal")) continue;
    Json list = Json::array();
    for (int goal = 0; goal < goals; ++goal) {
      Json place = robots[(k + static_cast<std::size_t>(goal)) % robots.size()]["start"];
      place["service"] = goal % 3;
      if (goal % 5 == 4)
        place["radius_after"] = request["robot_defaults"]["radius"].get<double>() * (1.0 + goal % 2);
      if (goal % 7 == 3) place["linear_speed_after"] = 1e-3 * (1 + goal);  // each another load
      list.push_back(std::move(place));
    }
    list.push_back(robots[k]["goal"]);
    robots[k].erase("goal");
    robots[k]["goals"] = std::move(list);
  }
  const bool has_open_goals = choices.yes();
  if (has_open_goals) add_open_goals(robots, choices);
  if (!has_open_goals && options.contains("start_overlap")) add_tolerances(robots, 0);
  if (choices.yes()) {
    request["robot_defaults"]["linear_acceleration"] = choices.one_of(std::array{1e-3, 0.5, 1e6});
    request["robot_defaults"]["angular_acceleration"] = choices.one_of(std::array{1e-3, 2.0, 1e6});
    for (Json& robot : robots) {
      std::size_t number = 0;
      for (Json& goal : robot["goals"]) {
        if (++number % 3 == 0) goal["linear_acceleration_after"] = number % 2 == 0 ? 1e-3 : 1.0;
      }
      if (robot["goals"].empty()) robot.erase("goals");
    }
  }
}

/// Robots that go to and fro in rows of their own, or in one row.
struct ToAndFro {
  Json robots = Json::array();
  Json plans = Json::array();
  int legs = 0;
};

/// Returns the duration of a way at 1 m/s, and its profile if acceleration is limited.
std::pair<double, Json> timed(double length, const std::optional<double>& acceleration) {
  if (!acceleration) return {1.01 * length, nullptr};
  const double cruise = std::min(1.0, std::sqrt(*acceleration * length));
  return {length / cruise + cruise / *acceleration, {{"start", 0.0}, {"cruise", cruise}, {"end", 0.0}}};
}

ToAndFro to_and_fro(const Extent& extent, double pitch, Choices& choices) {
  ToAndFro fleet;
  const int max_robots = static_cast<int>(std::min(300.0, extent.height / pitch));
  const int robots = 1 + choices.up_to(max_robots - 1);
  fleet.legs = 1 + choices.up_to(std::min(3000, 60'000 / robots));
  const double length = std::max(0.1, extent.width - pitch) * choices.one_of(std::array{1.0, 0.3, 0.001});
  const bool waits = choices.yes();
  std::optional<double> acceleration;
  if (choices.yes()) acceleration = choices.one_of(std::array{1e-3, 0.5, 1e6});
  const auto [duration, profile] = timed(length, acceleration);
  for (int k = 0; k < robots; ++k) {
    const std::string id = name_of('r', k);
    const double y = pitch * (k + 0.5);
    const std::array<Json, 2> ends{Json{{"x", 0.5 * pitch}, {"y", y}, {"theta", 0.0}},
                                   Json{{"x", 0.5 * pitch + length}, {"y", y}, {"theta", 0.0}}};
    Json actions = Json::array();
    double now = 0.0;
    for (int leg = 0; leg < fleet.legs; ++leg) {
      const auto from = static_cast<std::size_t>(leg % 2);
      const double end = now + duration;
      actions.push_back({{"type", "translate"},
                         {"t_start", now},
                         {"t_end", end},
                         {"from", ends[from]},
                         {"to", ends[1 - from]},
                         {"reverse", from == 1}});
      if (acceleration) actions.back()["profile"] = profile;
      now = end;
      if (!waits) continue;
      actions.push_back({{"type", "wait"},
                         {"t_start", now},
                         {"t_end", now + 0.5},
                         {"from", ends[1 - from]},
                         {"to", ends[1 - from]}});
      now += 0.5;
    }
    fleet.robots.push_back({{"id", id}, {"start", ends[0]}, {"may_reverse", true}});
    if (acceleration) fleet.robots.back()["linear_acceleration"] = *acceleration;
    fleet.plans.push_back({{"robot", id}, {"cost", now}, {"actions", std::move(actions)}});
  }
  return fleet;
}

Json disturbance_of(Choices& choices) {
  Json disturbance = Json::object();
  if (choices.yes()) disturbance["speed"] = {{"min", 0.01}, {"max", 1.0}};
  if (choices.yes()) {
    disturbance["stops"] = {{"rate_per_hour", choices.one_of(std::array{1.0, 3600.0, 36'000.0})},
                            {"mean_s", choices.one_of(std::array{0.001, 10.0})}};
  }
  if (choices.yes()) disturbance["start_delay"] = {{"min", 0.0}, {"max", 5.0}};
  if (choices.yes()) {
    disturbance["cross_track"] = {{"sigma", choices.one_of(std::array{0.001, 0.5})},
                                  {"correlation_length", choices.one_of(std::array{0.01, 1.0})}};
  }
  return disturbance;
}

/// Every robot waits for its neighbour, leg by leg.
Json dependencies_of(const ToAndFro& fleet, Choices& choices) {
  Json dependencies = Json::array();
  const auto place = [&](std::size_t robot, int leg) {
    const std::size_t actions = fleet.plans[robot]["actions"].size();
    return Json{{"robot", fleet.plans[robot]["robot"]},
                {"action", static_cast<std::size_t>(leg) * actions / static_cast<std::size_t>(fleet.legs)},
                {"progress", 0.5}};
  };
  const int every = 1 + choices.up_to(10);
  for (std::size_t robot = 0; robot + 1 < fleet.plans.size(); ++robot) {
    for (int leg = 1; leg < fleet.legs; leg += every) {
      dependencies.push_back({{"gate", place(robot, leg)}, {"until", place(robot + 1, leg - 1)}});
    }
  }
  return dependencies;
}

Json states_of(const ToAndFro& fleet, Choices& choices) {
  Json states = Json::array();
  for (const Json& plan : fleet.plans) {
    if (choices.yes()) continue;
    states.push_back({{"robot", plan["robot"]},
                      {"action", 0},
                      {"progress", 0.5},
                      {"speed_factor", choices.one_of(std::array{0.01, 1.0, 100.0})}});
  }
  return states;
}

/// How far robots say that they are, some of them at the end of a long plan.
Json reports_of(const ToAndFro& fleet, Choices& choices) {
  Json reports = Json::array();
  const bool is_measured = choices.yes();
  const bool is_released = choices.yes();
  for (const Json& plan : fleet.plans) {
    if (choices.yes()) continue;
    const Json& actions = plan["actions"];
    const auto last = static_cast<int>(actions.size()) - 1;
    const int number = choices.yes() ? last : choices.up_to(last);
    Json report{{"robot", plan["robot"]},
                {"action", number},
                {"progress", choices.one_of(std::array{0.0, 0.5, 1.0})}};
    if (is_measured) report.update(actions[static_cast<std::size_t>(number)]["to"]);
    if (is_released) report["released"] = {{"action", last}, {"progress", 1.0}};
    reports.push_back(std::move(report));
  }
  return reports;
}

/// Orders of many nodes that vehicles have, from the first place of each robot on.
Json base_of(const ToAndFro& fleet, Choices& choices) {
  Json base = Json::array();
  const int nodes = 1 + choices.up_to(2000);
  const int most = 1 + choices.up_to(100);
  for (const Json& plan : fleet.plans) {
    if (static_cast<int>(base.size()) >= most) break;
    Json list = Json::array();
    for (int node = 0; node < nodes; ++node) {
      const Json& action = plan["actions"][static_cast<std::size_t>(node) % plan["actions"].size()];
      list.push_back({{"nodeId", name_of('n', node)},
                      {"sequenceId", 2 * node},
                      {"released", true},
                      {"nodePosition", action["from"]}});
    }
    list.back()["nodePosition"] = plan["actions"][0]["from"];
    base.push_back({{"robot", plan["robot"]},
                    {"order", {{"orderId", "o"}, {"orderUpdateId", 0}, {"nodes", std::move(list)}}}});
  }
  return base;
}

/// What vehicles report, with many actions.
Json messages_of(const ToAndFro& fleet, Choices& choices) {
  Json messages = Json::array();
  Json actions = Json::array();
  for (int k = choices.up_to(3000); k > 0; --k) {
    actions.push_back({{"actionId", name_of('a', k)}, {"actionStatus", "FINISHED"}});
  }
  for (const Json& plan : fleet.plans) {
    const Json& place = plan["actions"].back()["to"];
    messages.push_back({{"serialNumber", plan["robot"]},
                        {"orderId", "o"},
                        {"orderUpdateId", 0},
                        {"lastNodeSequenceId", 2 * choices.up_to(100)},
                        {"agvPosition", place},
                        {"actionStates", messages.empty() ? actions : Json::array()}});
  }
  return messages;
}

/// The travel times from all starts to all goals of a request to plan, as far as they are not too many pairs.
Json matrix_of(const Json& request) {
  constexpr std::size_t kMax = 500;
  Json from = Json::array();
  Json to = Json::array();
  for (const Json& robot : request["robots"]) {
    if (from.size() < kMax) from.push_back(robot["start"]);
    if (to.size() == kMax || !(robot.contains("goal") || robot.contains("goals"))) continue;
    const Json& goal = robot.contains("goal") ? robot["goal"] : robot["goals"][0];
    const Json& pose = goal.contains("any_of") ? goal["any_of"][0] : goal;
    to.push_back({{"x", pose["x"]}, {"y", pose["y"]}});
  }
  Json matrix{{"map", request["map"]}, {"robot", request["robot_defaults"]}, {"from", from}, {"to", to}};
  if (request.contains("zones")) matrix["zones"] = request["zones"];
  matrix["options"] = request["options"];
  if (from.size() % 2 == 1) matrix["format"] = "integers";
  return matrix;
}

/// Margins for a request to plan, of many candidates.
Json margins_of(Json request, Choices& choices) {
  Json body{{"disturbance", disturbance_of(choices)}};
  // It may be that nothing disturbs.
  body["disturbance"]["start_delay"] = {{"min", 0.0}, {"max", choices.one_of(std::array{0.1, 1e6})}};
  body["policy"] = choices.one_of(std::array{"open_loop", "absorb_waits", "dependencies", "clock_stop"});
  if (body["policy"] == "clock_stop") body["max_delay"] = choices.one_of(std::array{0.0, 1.0, 1e8});
  body["aim"] = {{"collisions", choices.one_of(std::array{0.5, 0.01, 1e-4})}};
  if (choices.yes()) body["try"]["interval_margin"] = {0.0, 1e-3, 1.0, 1e3, 1e8};
  if (choices.yes()) body["try"]["inflation"] = {0.0, 1e-3, 0.2, 10.0};
  body["request"] = std::move(request);
  return body;
}

/// Tasks for the robots of a request to plan, at their starts and goals.
Json tasks_of(Json request, Choices& choices) {
  const std::size_t robots = request["robots"].size();
  const int goals = 1 + choices.up_to(20);
  const bool is_named = choices.yes();
  Json tasks = Json::array();
  for (std::size_t k = 0; k < robots && k < api::kMaxPairs / robots; ++k) {
    Json task{{"id", std::to_string(k)}, {"goals", Json::array()}};
    for (int goal = 0; goal < goals; ++goal) {
      const Json& start = request["robots"][(k + static_cast<std::size_t>(goal)) % robots]["start"];
      task["goals"].push_back({{"x", start["x"]}, {"y", start["y"]}, {"service", goal}});
    }
    if (is_named) task["robots"] = {request["robots"][k]["id"], request["robots"][0]["id"]};
    tasks.push_back(task);
  }
  return {{"request", std::move(request)}, {"tasks", tasks}};
}

}  // namespace

Effort planning_effort(Choices choices) {
  const int columns = 1 + choices.up_to(600);
  const int rows = 1 + choices.up_to(500);
  const auto resolution = choices.one_of(std::array{1.0, 0.05, 1e-3, 1000.0});
  const auto radius =
      std::max(2.0 * kLeastRadius, resolution * choices.one_of(std::array{0.3, 0.5, 0.49999, 1e-6, 3.0}));
  const Json lines = rows_of(columns, rows, choices);
  const int robots = 1 + choices.up_to(1999);
  Json request{
      {"map", {{"rows", lines}, {"resolution", resolution}}},
      {"robots", robots_of(robots, lines, resolution, choices)},
      {"robot_defaults",
       {{"radius", radius},
        {"linear_speed", choices.one_of(std::array{1.0, 1e-3, 1e3})},
        {"angular_speed", choices.one_of(std::array{1.0, 1e-3, 1e6})}}},
      {"options",
       {{"time_budget_ms", 100'000},
        {"mode", choices.yes() ? "anytime" : "first"},
        {"max_iterations", 40},
        {"reordering", choices.one_of(std::array{"raise_failed", "random", "none"})},
        {"inflation", resolution * choices.one_of(std::array{0.0, 0.01, 0.9, 10.0})},
        {"start_safe_interval", choices.one_of(std::array{3.0, 0.0, 1000.0})},
        {"wait_before_move", choices.one_of(std::array{0.0, 1.0})}}},
  };
  const std::int64_t steps = choices.up_to(3000);
  const std::size_t memory = static_cast<std::size_t>(1 + choices.up_to(63)) << 20;
  add_members(request, choices);
  const std::size_t count = request["robots"].size();
  const int kind = choices.up_to(4);
  if (kind == 2) {
    add_files(request, choices);
    return {api::matrix_endpoint, false, matrix_of(request).dump(), count, steps, memory};
  }
  if (kind == 3) {
    Json body = tasks_of(std::move(request), choices);
    add_files(body["request"], choices);
    return {api::assign_endpoint, false, body.dump(), count, steps, memory};
  }
  if (kind == 4) {
    Json body = margins_of(std::move(request), choices);
    return {api::margins_endpoint, false, body.dump(), count, steps, memory};
  }
  if (choices.yes()) {  // two sizes
    for (std::size_t k = 1; k < count; k += 2) request["robots"][k]["radius"] = 0.5 * radius;
  }
  if (choices.yes()) {  // one robot much larger than the others, away from where these are if they are near
    const Extent extent = extent_of(request["map"]);
    Json& large = request["robots"][0];
    large["radius"] = 0.12 * std::min(extent.width, extent.height);
    large["start"] = {{"x", 0.87 * extent.width}, {"y", 0.13 * extent.height}};
    if (large.contains("goal")) large["goal"] = {{"x", 0.13 * extent.width}, {"y", 0.13 * extent.height}};
  }
  add_chosen_ways(request, choices);
  add_files(request, choices);
  return {api::plan_endpoint, true, request.dump(), count, steps, memory};
}

Effort execution_effort(Choices choices) {
  const int columns = 2 + choices.up_to(1000);
  const int rows = 1 + choices.up_to(300);
  const double pitch = choices.one_of(std::array{1.0, 0.7, 0.2});
  Json map{{"rows", rows_of(columns, rows, choices)}};
  const ToAndFro fleet = to_and_fro(extent_of(map), pitch, choices);
  Json body{{"map", std::move(map)},
            {"robots", fleet.robots},
            {"plans", fleet.plans},
            {"robot_defaults", {{"radius", 0.3}, {"linear_speed", 1.0}, {"angular_speed", 1.0}}},
            {"options", {{"time_budget_ms", 100'000}}}};
  Effort effort;
  effort.robots = fleet.robots.size();
  const int kind = choices.byte() % 6;
  if (kind < 3 && choices.yes()) add_members(body, choices);
  if (kind == 0) {
    effort.endpoint = api::validate_endpoint;
  } else if (kind == 1) {
    effort.endpoint = api::dependencies_endpoint;
    body["options"]["execution_margin"] = choices.one_of(std::array{0.0, 0.1, 1.0, 100.0});
    body["options"]["dependency_slack"] = choices.one_of(std::array{0.1, 1e-3, 10.0});
  } else if (kind == 2) {
    effort.endpoint = api::simulate_endpoint;
    body["policy"] = choices.one_of(std::array{"open_loop", "absorb_waits", "dependencies", "clock_stop"});
    if (body["policy"] == "dependencies") body["dependencies"] = dependencies_of(fleet, choices);
    if (body["policy"] == "clock_stop") body["max_delay"] = 1.0;
    body["runs"] = 1 + choices.up_to(50);
    body["disturbance"] = disturbance_of(choices);
    if (choices.yes()) body["trace"] = 0;
  } else if (kind == 3) {
    effort.endpoint = api::advance_endpoint;
    Json request = body;
    request.erase("plans");
    body = {{"request", std::move(request)},
            {"plans", fleet.plans},
            {"at", choices.up_to(100) / 10.0},
            {"commit", choices.one_of(std::array{0.0, 1.0, 1e3})}};
    if (choices.yes()) body["states"] = reports_of(fleet, choices);
    if (choices.yes()) {
      body["request"]["robot_defaults"]["stop_distance"] = choices.one_of(std::array{0.1, 3.0, 1e6});
    }
  } else if (kind == 4) {
    effort.endpoint = api::retime_endpoint;
    body.erase("map");
    body["dependencies"] = dependencies_of(fleet, choices);
    body["at"] = 0.05;
    body["states"] = states_of(fleet, choices);
  } else {
    const bool imports = choices.yes();
    effort.endpoint = imports ? api::import_vda5050_endpoint : api::vda5050_endpoint;
    body.erase("options");
    body["version"] = choices.one_of(std::array{"2.1.0", "3.0.0"});
    body["manufacturer"] = "m";
    body["timestamp"] = "2026-01-31T12:00:00.000Z";
    body["dependencies"] = dependencies_of(fleet, choices);
    Json numbers = Json::object();
    const int most = choices.up_to(20'000);  // many: of robots that do not exist, too
    const int names = most < 5000 ? std::min(most, static_cast<int>(effort.robots)) : most;
    for (int k = 0; k < names; ++k) numbers[name_of('r', k)] = name_of('s', k);
    if (choices.yes()) body["manufacturers"] = numbers;
    if (choices.yes()) body["serial_numbers"] = std::move(numbers);
    if (choices.yes()) body["release_ahead"] = choices.one_of(std::array{0.1, 5.0, 1e8});
    if (choices.yes()) body["base"] = base_of(fleet, choices);
    if (imports) {
      body["messages"] = messages_of(fleet, choices);
      add_vehicle_members(body, choices);
    }
  }
  effort.body = body.dump();
  effort.steps = choices.up_to(3000);
  effort.memory = static_cast<std::size_t>(1 + choices.up_to(127)) << 20;
  return effort;
}

}  // namespace fleetplan::fuzz
