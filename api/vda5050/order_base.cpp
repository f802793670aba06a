#include "api/vda5050/order_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "api/json/faults.h"
#include "api/request/fleet/parse_robots.h"
#include "api/request/limits.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 3> kBaseMembers{"robot", "order", "state"};

/// The base of a robot as it is read.
class BaseReader {
 public:
  explicit BaseReader(const JsonReader& entry) : order_(message(entry.require("order"))) {
    const JsonReader state = message(entry.find("state"));
    const auto reached = state.find("lastNodeSequenceId").natural(kGreatestId);
    const bool is_of_order = state.find("orderId").string() == order_.find("orderId").string();
    if (reached && is_of_order) reached_ = *reached;
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
  void read_node(const JsonReader& node) {
    const auto sequence_id = node.require("sequenceId").natural(kGreatestId);
    const auto released = node.require("released").boolean();
    const JsonReader position = message(node.require("nodePosition"));
    const auto x = position.require("x").number(kCoordinate);
    const auto y = position.require("y").number(kCoordinate);
    node.require("nodeId").name();
    if (!sequence_id || !x || !y || released != true) return;
    base_.sequence_id = *sequence_id;
    base_.last = node;
    if (!reached_ || *sequence_id > *reached_) base_.still_to_do.emplace_back(*x, *y);
  }

  JsonReader order_;
  std::optional<std::uint64_t> reached_;
  OrderBase base_;
};

}  // namespace

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

namespace {

/// The last node of a base and the end of committed motion that are nearer are the same (metres): rounding.
constexpr double kSameNode = 1e-6;

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
bool passes_all(core::Actions actions, const std::vector<core::Position>& positions, core::Work& stop) {
  constexpr std::size_t kWorkOfAStep = 64;
  std::size_t action = 0;
  double fraction = 0.0;
  for (const core::Position& position : positions) {
    auto passed = action < actions.size() ? passes(actions[action], position, fraction) : std::nullopt;
    while (!passed) {
      if (stop.met_after(kWorkOfAStep) || ++action >= actions.size()) return false;
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
                                       const core::ActionPlace& closed, core::Work& stop) {
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
  if (!passes_all(committed, nodes, stop)) {
    return "The robot is not committed to pass the released nodes of order " + in_quotes(base.order_id) + ".";
  }
  if (closed < last_stand(committed)) {
    return node + " is behind a gate of the plan that is closed.";
  }
  return std::nullopt;
}

}  // namespace fleetplan::api
