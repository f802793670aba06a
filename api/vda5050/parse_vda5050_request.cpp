#include "api/vda5050/parse_vda5050_request.h"

#include <algorithm>
#include <utility>

#include "api/json/faults.h"
#include "api/request/fleet/parse_plans.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/options.h"
#include "api/request/ranges.h"
#include "api/vda5050/route.h"
#include "core/execution/executed_actions.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 2> kVersions{"2.1.0", "3.0.0"};  // in the order of VdaVersion
constexpr std::array<std::string_view, 6> kProgressMembers{
    "robot", "order_id", "order_update_id", "last_released_sequence_id", "action", "progress"};
constexpr std::uint64_t kMostUpdates = 4'294'967'294;  // ids are unsigned numbers of 32 bits

bool is_timestamp(std::string_view text) {
  constexpr std::string_view kShape = "0000-00-00T00:00:00";
  if (text.size() <= kShape.size() || text.back() != 'Z') return false;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t k = 0; k < kShape.size(); ++k) {
    if (kShape[k] == '0' ? !is_digit(text[k]) : text[k] != kShape[k]) return false;
  }
  const std::string_view fraction = text.substr(kShape.size(), text.size() - kShape.size() - 1);
  if (fraction.empty()) return true;
  return fraction.size() > 1 && fraction.front() == '.' &&
         std::all_of(fraction.begin() + 1, fraction.end(), is_digit);
}

OrderHeader read_header(const JsonReader& root) {
  OrderHeader header;
  if (const auto version = root.require("version").word(kVersions)) {
    header.version = static_cast<VdaVersion>(*version);
  }
  header.manufacturer = root.require("manufacturer").name().value_or("");
  header.map_id = root.find("map_id").name().value_or("map");
  const JsonReader timestamp = root.require("timestamp");
  header.timestamp = timestamp.name().value_or("");
  if (timestamp && timestamp.string() && !is_timestamp(header.timestamp)) {
    timestamp.must_be(fault::kOutOfRange, "a time in UTC like 2026-01-31T12:00:00.000Z");
  }
  return header;
}

std::vector<std::string> read_serial_numbers(const JsonReader& member,
                                             const std::vector<core::Robot>& robots) {
  std::vector<std::string> serials;
  serials.reserve(robots.size());
  for (const core::Robot& robot : robots) serials.push_back(robot.id);
  if (member && !member.value().is_object()) member.must_be(fault::kWrongType, "an object");
  const RobotNames names(robots);
  for (const JsonReader serial : member.members()) {
    const std::string_view id = serial.value().key();
    if (const auto robot = names.index_of(id)) {
      if (const auto name = serial.name()) serials[*robot] = *name;
    } else {
      serial.fault(fault::kUnknownKey, [&] { return "There is no robot " + in_quotes(id) + " in robots."; });
    }
  }
  return serials;
}

class ProgressReader {
 public:
  ProgressReader(const std::vector<core::Robot>& robots, const std::vector<core::Actions>& actions,
                 const std::vector<Route>& routes)
      : names_(robots), actions_(actions), routes_(routes), seen_(actions.size(), false) {}

  std::vector<OrderProgress> read(const JsonReader& member) {
    std::vector<OrderProgress> progress(actions_.size());
    for (const JsonReader item : member.array().items()) {
      const JsonReader json = item.object(kProgressMembers);
      const JsonReader robot_member = json.require("robot");
      const auto robot = names_.find(robot_member);
      if (!robot) continue;
      if (seen_[*robot])
        robot_member.fault(fault::kDuplicate, "The progress of this robot is given twice; give it once.");
      seen_[*robot] = true;
      progress[*robot] = read_one(json, *robot);
    }
    return progress;
  }

 private:
  OrderProgress read_one(const JsonReader& json, std::size_t robot) const {
    OrderProgress progress;
    progress.at = read_point(json, robot);
    const JsonReader order_id = json.find("order_id");
    const bool has_order = order_id && !order_id.is_null();
    const auto read_order = [&](std::string_view key) {
      return has_order ? json.require(key) : json.find(key);
    };
    const JsonReader update = read_order("order_update_id");
    const JsonReader last = read_order("last_released_sequence_id");
    const auto update_id = update.natural(kMostUpdates);
    const auto last_released = last.natural(kMostUpdates);
    if (!has_order) return progress;
    progress.order_id = order_id.name();
    progress.update_id = update_id.value_or(0);
    progress.last_released = last_released.value_or(0);
    const std::size_t nodes = routes_[robot].nodes.size();
    if (progress.last_released % 2 != 0 || progress.last_released >= 2 * nodes) {
      last.fault(fault::kOutOfRange, [&] {
        return "The robot's order has " + std::to_string(nodes) +
               " nodes, with the sequence ids 0, 2, 4 and so on. Is the progress of an order of other plans?";
      });
    }
    return progress;
  }

  core::ActionPlace read_point(const JsonReader& json, std::size_t robot) const {
    const JsonReader action = json.require("action");
    const auto index = action.natural(kGreatestIndex);
    const auto fraction = json.require("progress").number(kFraction);
    if (!index || !fraction) return {};
    const std::size_t count = actions_[robot].size();
    // A robot that has no actions, or has executed all, may be at their end.
    if (*index < count || (*index == count && *fraction == 0.0)) {
      return core::place_of({robot, *index, *fraction});
    }
    action.fault(fault::kOutOfRange,
                 [&] { return "The robot has " + std::to_string(count) + " actions, numbered from 0."; });
    return {};
  }

  RobotNames names_;
  const std::vector<core::Actions>& actions_;
  const std::vector<Route>& routes_;
  std::vector<bool> seen_;
};

/// Returns the routes of all robots. Ends early when the stop is met.
std::vector<Route> routes_of(const VdaRequest& request, const std::vector<core::Actions>& actions,
                             double wait_before_move, core::Work& stop) {
  // A node is as much work as reading so many bytes.
  constexpr std::size_t kWorkOfANode = 256;
  const auto points = points_of(request.dependencies, request.robots.size());
  std::vector<Route> routes;
  routes.reserve(request.robots.size());
  for (std::size_t k = 0; k < request.robots.size(); ++k) {
    if (stop.met_after(kWorkOfANode * (1 + actions[k].size() + points[k].size()))) break;
    routes.push_back(route_of(request.robots[k], actions[k], points[k], wait_before_move));
  }
  return routes;
}

}  // namespace

std::optional<VdaRequest> parse_vda5050_request(const JsonReader& root, const Limits& limits,
                                                core::Work& stop) {
  VdaRequest request;
  request.header = read_header(root);
  const double wait_before_move = parse_options(root.find("options")).plan.wait_before_move;
  UniqueIds ids;
  // The map's frame is not applied, as orders are in the client's world.
  std::vector<ParsedRobot> robots =
      parse_robots(root.require("robots"), root.find("robot_defaults"), WorldFrame{}, limits, ids);
  request.plans = parse_plans(root.require("plans"), robots, WorldFrame{});
  if (root.fault_count() > 0 || stop.met()) return std::nullopt;
  for (ParsedRobot& robot : robots) request.robots.push_back(std::move(robot.robot));
  request.dependencies = parse_dependencies(
      root.require("dependencies",
                   "; make them with POST /v1/dependencies, or with options.dependencies of POST /v1/plan"),
      request.robots, request.plans);
  request.serial_numbers = read_serial_numbers(root.find("serial_numbers"), request.robots);
  const auto actions = core::executed_actions(request.robots, request.plans);
  request.routes = routes_of(request, actions, wait_before_move, stop);
  if (stop.met()) return std::nullopt;
  request.progress = ProgressReader(request.robots, actions, request.routes).read(root.find("progress"));
  if (root.fault_count() > 0 || stop.met()) return std::nullopt;
  return request;
}

}  // namespace fleetplan::api
