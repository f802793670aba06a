#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "api/request/fleet/parse_plans.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"
#include "api/request/options.h"
#include "api/vda5050/export.h"
#include "api/vda5050/route.h"
#include "core/execution/executed_actions.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 3> kBaseMembers{"robot", "order", "state"};

/// The base of a robot as it is read.
class BaseReader {
 public:
  explicit BaseReader(const JsonReader& entry) : order_(message(entry.require("order"))) {
    // What a vehicle has reported is no fault of the request, whatever it is.
    const JsonReader state = entry.find("state");
    const auto order_id = state.find("orderId").string();
    base_.is_known = order_id && order_id == order_.find("orderId").string();
    const bool has_node = !state.find("lastNodeId").string().value_or("").empty();
    if (base_.is_known && has_node) reached_ = state.find("lastNodeSequenceId").natural();
    base_.is_unsure = state && !reached_;
    if (base_.is_known) read_finished(state.find("actionStates"));
  }

  /// Reads the order; none if it has a fault.
  std::optional<OrderBase> read() {
    const std::size_t before = order_.fault_count();
    base_.order_id = order_.require("orderId").name().value_or("");
    base_.update_id = order_.require("orderUpdateId").natural(kGreatestId).value_or(0);
    const JsonReader nodes = order_.require("nodes").array();
    for (const JsonReader node : nodes.items()) read_node(message(node));
    if (nodes && !base_.last && order_.fault_count() == before) {
      nodes.must_be(fault::kOutOfRange, "an order's nodes, of which the first one is released");
    }
    return order_.fault_count() == before ? std::optional(std::move(base_)) : std::nullopt;
  }

 private:
  void read_finished(const JsonReader& actions) {
    // Bounded: the actions in the body.
    for (const JsonReader action : actions.items()) {
      const auto id = action.find("actionId").string();
      if (id && action.find("actionStatus").string() == "FINISHED") base_.finished.insert(*id);
    }
  }

  void read_node(const JsonReader& node) {
    const auto sequence_id = node.require("sequenceId").natural(kGreatestId);
    const auto released = node.require("released").boolean();
    const JsonReader position = message(node.require("nodePosition"));
    const auto x = position.require("x").number(kCoordinate);
    const auto y = position.require("y").number(kCoordinate);
    node.require("nodeId").name();
    base_.has_horizon = base_.has_horizon || released == false;
    if (!sequence_id || !x || !y || released != true) return;
    base_.sequence_id = *sequence_id;
    base_.last = node;
    base_.released.push_back(node);
    if (!reached_ || *sequence_id > *reached_) base_.still_to_do.emplace_back(*x, *y);
  }

  JsonReader order_;
  std::optional<std::uint64_t> reached_;
  OrderBase base_;
};

/// Reads `base`: of each robot at most one order, and the state of its vehicle. Returns them by robot.
std::vector<std::optional<OrderBase>> parse_bases(const JsonReader& member,
                                                  const std::vector<core::Robot>& robots) {
  std::vector<std::optional<OrderBase>> bases(robots.size());
  std::vector<bool> seen(robots.size(), false);
  const RobotNames names(robots);
  // Bounded: the nodes of the orders in the body.
  for (const JsonReader item : member.array().items()) {
    const JsonReader entry = item.object(kBaseMembers);
    const JsonReader robot_member = entry.require("robot");
    const auto robot = names.find(robot_member);
    auto base = BaseReader(entry).read();
    if (!robot) continue;
    if (seen[*robot]) {
      robot_member.fault(fault::kDuplicate, "The order of this robot is given twice; give its last message.");
    }
    seen[*robot] = true;
    bases[*robot] = std::move(base);
  }
  return bases;
}

/// A robot that is measured beside its path goes straight back to the end of its action. So far it may pass
/// beside nodes on its way (metres), which is the pose_tolerance of POST /v1/advance by default.
constexpr double kBesideNode = 0.1;

/// Committed motion that ends at times that are nearer is the same (seconds): rounding.
constexpr double kSameEnd = 1e-6;

/// The fraction of an action at which it comes past a position, from a fraction on.
std::optional<double> passes(const core::Action& action, const core::Position& position, double from) {
  const core::Position path = action.to.position - action.from.position;
  const double squared = path.squaredNorm();
  const double along = squared > 0.0 ? (position - action.from.position).dot(path) / squared : from;
  const double fraction = std::clamp(along, from, 1.0);
  const core::Position nearest = action.from.position + fraction * path;
  return (nearest - position).norm() <= kBesideNode ? std::optional(fraction) : std::nullopt;
}

/// Whether a robot that executes these actions comes past all positions in their order.
bool passes_all(core::Actions actions, const std::vector<core::Position>& positions, core::Work& work) {
  constexpr std::size_t kWorkOfAStep = 64;
  std::size_t action = 0;
  double fraction = 0.0;
  for (const core::Position& position : positions) {
    auto passed = action < actions.size() ? passes(actions[action], position, fraction) : std::nullopt;
    while (!passed) {
      if (work.met_after(kWorkOfAStep) || ++action >= actions.size()) return false;
      passed = passes(actions[action], position, 0.0);
    }
    fraction = *passed;
  }
  return true;
}

std::string text_of(const core::Position& position) {
  return std::string("(").append(number_text(position.x())).append(", ").append(number_text(position.y())) +
         ')';
}

}  // namespace

core::ActionPlace last_stand(core::Actions actions) {
  std::size_t end = actions.size();
  while (end > 0 && actions[end - 1].from.position == actions[end - 1].to.position) --end;
  return {end, 0.0};
}

std::optional<std::string> why_it_ends(const OrderBase& base, const core::Robot& robot, core::Actions actions,
                                       const core::ActionPlace& closed, core::Work& work) {
  const JsonReader position = base.last.find("nodePosition");
  const core::Position last(position.find("x").number(kCoordinate).value_or(0.0),
                            position.find("y").number(kCoordinate).value_or(0.0));
  const core::Position end = robot.committed_end().position;
  const std::string node = "The last released node of order " + in_quotes(base.order_id);
  if ((end - last).norm() > kSameNode) {
    return node + " is at " + text_of(last) + ", but the robot is committed to come to " + text_of(end) + ".";
  }
  const std::size_t count = robot.committed.size();
  const bool is_executed =
      count <= actions.size() &&
      (count == 0 || std::abs(actions[count - 1].t_end - robot.committed.back().t_end) <= kSameEnd);
  if (!is_executed) return "The plan does not begin with the robot's committed actions.";
  const core::Actions committed = actions.first(count);
  std::vector<core::Position> nodes = base.still_to_do;
  if (!nodes.empty()) nodes.pop_back();  // where the motion ends
  bool passes = passes_all(committed, nodes, work);
  while (!passes && base.is_unsure && !nodes.empty() && !work.met()) {
    nodes.erase(nodes.begin());
    passes = passes_all(committed, nodes, work);
  }
  if (!passes) {
    return "The robot is not committed to pass the released nodes of order " + in_quotes(base.order_id) + ".";
  }
  if (closed < last_stand(committed)) {
    return node + " is behind a gate of the plan that is closed.";
  }
  return std::nullopt;
}

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

namespace {

constexpr std::array<std::string_view, 2> kVersions{"2.1.0", "3.0.0"};  // in the order of VdaVersion
constexpr std::array<std::string_view, 9> kProgressMembers{
    "robot",     "order_id",       "order_update_id", "last_released_sequence_id", "action", "progress",
    "cancel_id", "ended_order_id", "served"};
constexpr Range kReleaseAhead{0.1, kLongestTime, "seconds"};
constexpr Range kDeviation{0.0, 1e6, "metres"};

OrderHeader read_header(const JsonReader& root) {
  OrderHeader header;
  if (const auto version = root.require("version").word(kVersions)) {
    header.version = static_cast<VdaVersion>(*version);
  }
  header.manufacturer = root.require("manufacturer").name().value_or("");
  const JsonReader timestamp = root.require("timestamp");
  header.timestamp = timestamp.name().value_or("");
  if (timestamp && timestamp.string() && !is_timestamp(header.timestamp)) {
    timestamp.must_be(fault::kOutOfRange, "a time in UTC like 2026-01-31T12:00:00.000Z");
  }
  return header;
}

/// Reads an object with a name for each of some robots.
template <typename Take>
void read_names(const JsonReader& member, const RobotNames& robots, const Take& take) {
  if (member && !member.value().is_object()) member.must_be(fault::kWrongType, "an object");
  for (const JsonReader entry : member.members()) {
    const std::string_view id = entry.value().key();
    if (const auto robot = robots.index_of(id)) {
      if (const auto name = entry.name()) take(*robot, *name);
    } else {
      entry.fault(fault::kUnknownKey, [&] { return "There is no robot " + in_quotes(id) + " in robots."; });
    }
  }
}

std::vector<Vehicle> read_vehicles(const JsonReader& root, const std::string& manufacturer,
                                   const std::vector<core::Robot>& robots) {
  const std::string map_id = root.find("map_id").name().value_or("map");
  std::vector<Vehicle> vehicles;
  vehicles.reserve(robots.size());
  for (const core::Robot& robot : robots) vehicles.push_back({manufacturer, robot.id, map_id});
  const RobotNames names(robots);
  read_names(root.find("manufacturers"), names,
             [&](std::size_t robot, const std::string& name) { vehicles[robot].manufacturer = name; });
  read_names(root.find("serial_numbers"), names,
             [&](std::size_t robot, const std::string& name) { vehicles[robot].serial_number = name; });
  read_names(root.find("map_ids"), names,
             [&](std::size_t robot, const std::string& name) { vehicles[robot].map_id = name; });
  return vehicles;
}

/// Where a robot is that has reported nothing: at its start, with the order that it has had then, if any.
OrderProgress first_progress(const std::optional<OrderBase>& base) {
  OrderProgress progress;
  if (!base) return progress;
  progress.order_id = base->order_id;
  progress.update_id = base->update_id;
  progress.last_released = base->sequence_id;
  return progress;
}

class ProgressReader {
 public:
  explicit ProgressReader(const VdaRequest& request)
      : request_(request), names_(request.robots), seen_(request.robots.size(), false) {}

  std::vector<OrderProgress> read(const JsonReader& member) {
    std::vector<OrderProgress> progress;
    progress.reserve(request_.bases.size());
    for (const auto& base : request_.bases) progress.push_back(first_progress(base));
    for (const JsonReader item : member.array().items()) {
      const JsonReader json = item.object(kProgressMembers);
      const JsonReader robot_member = json.require("robot");
      const auto robot = names_.find(robot_member);
      if (!robot) continue;
      if (seen_[*robot])
        robot_member.fault(fault::kDuplicate, "The progress of this robot is given twice; give it once.");
      seen_[*robot] = true;
      OrderProgress& of_robot = progress[*robot] = {};
      of_robot.at = read_point(json, *robot);
      of_robot.served = json.find("served").natural(kGreatestIndex).value_or(0);
      read_order(json, *robot, of_robot);
    }
    return progress;
  }

 private:
  void read_order(const JsonReader& json, std::size_t robot, OrderProgress& progress) const {
    const JsonReader order_id = json.find("order_id");
    const bool has_order = order_id && !order_id.is_null();
    const auto read_of_order = [&](std::string_view key) {
      return has_order ? json.require(key) : json.find(key);
    };
    const JsonReader last = read_of_order("last_released_sequence_id");
    const auto update_id = read_of_order("order_update_id").natural(kGreatestId);
    const auto last_released = last.natural(kGreatestId);
    progress.cancel_id = json.find("cancel_id").name();
    const auto ended = json.find("ended_order_id").name();
    if (!has_order) progress.ended_order_id = ended;
    if (!has_order) return;
    progress.order_id = order_id.name();
    progress.update_id = update_id.value_or(0);
    progress.last_released = last_released.value_or(0);
    const auto& base = request_.bases[robot];
    if (base && progress.order_id && *progress.order_id != base->order_id) {
      order_id.must_be(fault::kUnknownValue, [&] { return "that of base, " + in_quotes(base->order_id); });
    }
    const Route& route = request_.routes[robot];
    if (route.node_of(progress.last_released)) return;
    last.fault(fault::kOutOfRange, [&] {
      return "The robot's order has " + std::to_string(route.nodes.size()) +
             " nodes, with the sequence ids " + std::to_string(route.sequence_id(0)) + ", " +
             std::to_string(route.sequence_id(1)) + ", " + std::to_string(route.sequence_id(2)) +
             " and so on. Is the progress of an order of other plans?";
    });
  }

  core::ActionPlace read_point(const JsonReader& json, std::size_t robot) const {
    const JsonReader action = json.require("action");
    const auto index = action.natural(kGreatestIndex);
    const auto fraction = json.require("progress").number(kFraction);
    if (!index || !fraction) return {};
    const std::size_t count = request_.actions[robot].size();
    // A robot that has no actions, or has executed all, may be at their end.
    if (*index < count || (*index == count && *fraction == 0.0)) {
      return core::place_of({robot, *index, *fraction});
    }
    action.fault(fault::kOutOfRange,
                 [&] { return "The robot has " + std::to_string(count) + " actions, numbered from 0."; });
    return {};
  }

  const VdaRequest& request_;
  RobotNames names_;
  std::vector<bool> seen_;
};

/// Where the route of a robot begins: behind what it is committed to, if its order goes on with that.
RouteStart start_of(const VdaRequest& request, std::size_t robot) {
  const auto& base = request.bases[robot];
  if (!base) return {};
  return {.action = std::min(request.robots[robot].committed.size(), request.actions[robot].size()),
          .sequence_id = base->sequence_id,
          .is_known = true};
}

/// The least number of nodes that are released ahead, except where a gate is closed.
constexpr double kNodesAhead = 2.0;

/// Reports a time ahead that is so short that plans of this length would have too many nodes. Returns whether
/// it is long enough.
bool is_long_enough(const JsonReader& member, const VdaRequest& request) {
  constexpr double kMaxNodes = 30'000.0;  // about 13 MiB
  if (!request.release_ahead) return true;
  double nodes = 0.0;
  // Bounded: the actions in the body.
  for (const core::Actions actions : request.actions) {
    for (const core::Action& action : actions) {
      if (action.type != core::Action::Type::translate) continue;
      nodes += (action.t_end - action.t_start) * kNodesAhead / *request.release_ahead;
    }
  }
  if (nodes <= kMaxNodes) return true;
  member.fault(fault::kOutOfRange, [&] {
    return "The plans would have " + number_text(std::ceil(nodes)) +
           " nodes, of which this service makes 30,000 at most; give a longer time, or leave it out.";
  });
  return false;
}

/// Returns the routes of all robots. Ends early when `work` is met.
std::vector<Route> routes_of(const VdaRequest& request, double wait_before_move, core::Work& work) {
  // A node is as much work as reading so many bytes.
  constexpr std::size_t kWorkOfANode = 256;
  auto points = points_of(request.gates, request.robots.size());
  std::vector<Route> routes;
  routes.reserve(request.robots.size());
  for (std::size_t k = 0; k < request.robots.size(); ++k) {
    const core::Actions actions = request.actions[k];
    if (request.release_ahead) {
      points[k] =
          with_points_within(*request.release_ahead / kNodesAhead, std::move(points[k]), actions, work);
    }
    if (work.met_after(kWorkOfANode * (1 + actions.size() + points[k].size()))) break;
    routes.push_back(route_of(request.robots[k], actions, points[k], wait_before_move, start_of(request, k)));
  }
  return routes;
}

}  // namespace

std::optional<VdaRequest> parse_vda5050_request(const JsonReader& root, const Limits& limits,
                                                core::Work& work) {
  VdaRequest request;
  request.header = read_header(root);
  const double wait_before_move = parse_options(root.find("options")).plan.wait_before_move;
  UniqueIds ids;
  // The map's frame is not applied, as orders are in the client's world.
  std::vector<ParsedRobot> robots =
      parse_robots(root.require("robots"), root.find("robot_defaults"), WorldFrame{}, limits, ids);
  request.plans = parse_plans(root.require("plans"), robots, WorldFrame{});
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  for (ParsedRobot& robot : robots) {
    request.goals.push_back(std::move(robot.goals));
    request.robots.push_back(std::move(robot.robot));
  }
  const auto dependencies = parse_dependencies(
      root.require("dependencies",
                   "; make them with POST /v1/dependencies, or with options.dependencies of POST /v1/plan"),
      request.robots, request.plans);
  request.vehicles = read_vehicles(root, request.header.manufacturer, request.robots);
  request.release_ahead = root.find("release_ahead").number(kReleaseAhead);
  request.allowed_deviation = root.find("allowed_deviation").number(kDeviation);
  request.bases = parse_bases(root.find("base"), request.robots);
  request.actions = core::executed_actions(request.robots, request.plans);
  request.gates = gates_of(dependencies, request.actions);
  if (!is_long_enough(root.find("release_ahead"), request)) return std::nullopt;
  request.routes = routes_of(request, wait_before_move, work);
  if (work.met()) return std::nullopt;
  request.progress = ProgressReader(request).read(root.find("progress"));
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  return request;
}

}  // namespace fleetplan::api
