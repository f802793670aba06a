#include "api/vda5050/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/request/limits.h"
#include "api/vda5050/export.h"
#include "core/geometry/position.h"

namespace fleetplan::api {

namespace {

/// Whether the value is one of two words.
bool is_either(const JsonReader& value, std::string_view one, std::string_view other) {
  const auto text = value.string();
  return text && (*text == one || *text == other);
}

class StateReader {
 public:
  StateReader(const JsonReader& json, const OrderProgress& progress) : json_(json), progress_(progress) {}

  VehicleState read() {
    const JsonReader order_id = json_.require("orderId");
    state_.order_id = order_id.string().value_or("");
    if (order_id && !order_id.string()) order_id.must_be(fault::kWrongType, "a string");
    state_.update_id = json_.require("orderUpdateId").natural(kGreatestId).value_or(0);
    state_.last_sequence_id = json_.require("lastNodeSequenceId").natural(kGreatestId).value_or(0);
    for (const std::string_view name :
         {"agvPosition", "mobileRobotPosition"}) {  // up to 2.1, and from 3.0 on
      read_pose(message(json_.find(name)));
    }
    // Bounded: the items of two lists in the body.
    for (const std::string_view list : {"actionStates", "instantActionStates"}) {
      for (const JsonReader item : json_.find(list).array().items()) read_action(message(item));
    }
    for (const JsonReader item : json_.find("nodeStates").array().items()) {
      const auto sequence_id = message(item).require("sequenceId").natural(kGreatestId);
      if (sequence_id && !state_.next_sequence_id) state_.next_sequence_id = sequence_id;
    }
    for (const JsonReader item : json_.find("errors").array().items()) read_error(message(item));
    return std::move(state_);
  }

 private:
  void read_pose(const JsonReader& position) {
    if (!position) return;
    const auto x = position.require("x").number(kCoordinate);
    const auto y = position.require("y").number(kCoordinate);
    const auto theta = position.require("theta").number(kAnyAngle);
    const auto is_initialized = position.find("positionInitialized").boolean();
    const auto is_localized = position.find("localized").boolean();
    const bool is_known = is_initialized.value_or(is_localized.value_or(true));
    if (!x || !y || !theta || !is_known || state_.pose) return;
    state_.pose = core::Pose{{*x, *y}, core::normalize_angle(*theta)};
  }

  void read_action(const JsonReader& action) {
    const auto id = action.require("actionId").string();
    const JsonReader status = action.require("actionStatus");
    if (id && is_either(status, "FINISHED", "FAILED")) state_.ended_actions.insert(*id);
  }

  void read_error(const JsonReader& error) {
    if (is_either(error.require("errorLevel"), "FATAL", "CRITICAL")) state_.has_failed = true;
    // A message that is refused is a warning that refers to the order and its update.
    const std::string update = std::to_string(progress_.update_id);
    bool order = false;
    bool of_update = false;
    for (const JsonReader item : error.find("errorReferences").array().items()) {
      const JsonReader reference = message(item);
      const auto value = reference.find("referenceValue").string();
      if (!value) continue;
      const auto key = reference.find("referenceKey").string();
      order = order || (key == "orderId" && value == progress_.order_id);
      of_update = of_update || (key == "orderUpdateId" && *value == update);
    }
    if (order && of_update) state_.has_failed = true;
  }

  JsonReader json_;
  const OrderProgress& progress_;
  VehicleState state_;
};

/// The robots by what their vehicles' messages say of the sender.
class Senders {
 public:
  explicit Senders(const std::vector<Vehicle>& vehicles) {
    for (std::size_t k = 0; k < vehicles.size(); ++k) {
      const Vehicle& vehicle = vehicles[k];
      const auto [first, is_new] = robots_.emplace(vehicle.serial_number, k);
      if (!is_new && vehicles[first->second].manufacturer != vehicle.manufacturer) {
        of_several_makes_.insert(vehicle.serial_number);
      }
      robots_of_makes_.emplace(std::pair(vehicle.manufacturer, vehicle.serial_number), k);
    }
  }

  /// The robot of a message with this serial number. Only where several makes have it, the manufacturer
  /// counts.
  std::optional<std::size_t> find(const JsonReader& message, const std::string& serial) const {
    if (!of_several_makes_.contains(serial)) {
      if (const auto robot = robots_.find(serial); robot != robots_.end()) return robot->second;
      message.find("serialNumber").fault(fault::kUnknownRobot, [&] {
        return "There is no robot with the serial number " + in_quotes(serial) + ".";
      });
      return std::nullopt;
    }
    const JsonReader make = message.require("manufacturer", ", as several makes have this serial number");
    const auto name = make.name();
    if (!name) return std::nullopt;
    const auto robot = robots_of_makes_.find({*name, serial});
    if (robot != robots_of_makes_.end()) return robot->second;
    make.fault(fault::kUnknownRobot, [&] {
      return "There is no robot of this manufacturer with the serial number " + in_quotes(serial) + ".";
    });
    return std::nullopt;
  }

 private:
  std::unordered_map<std::string, std::size_t> robots_;  // by serial number, the first of several
  std::unordered_set<std::string> of_several_makes_;     // serial numbers
  std::map<std::pair<std::string, std::string>, std::size_t> robots_of_makes_;  // by manufacturer and number
};

}  // namespace

std::vector<std::optional<VehicleState>> parse_states(const JsonReader& member, const VdaRequest& request) {
  const Senders senders(request.vehicles);
  std::vector<std::optional<VehicleState>> states(request.robots.size());
  // Bounded: the messages in the body.
  for (const JsonReader item : member.array().items()) {
    const JsonReader json = message(item);
    const JsonReader serial = json.require("serialNumber");
    const auto name = serial.name();
    if (!name) continue;
    const auto robot = senders.find(json, *name);
    if (!robot) continue;
    if (states[*robot]) {
      serial.fault(fault::kDuplicate, "There are two messages of this vehicle; give the last one.");
    } else {
      states[*robot] = StateReader(json, request.progress[*robot]).read();
    }
  }
  return states;
}

std::optional<VdaImport> parse_vda5050_import(const JsonReader& root, const Limits& limits,
                                              core::Work& work) {
  auto request = parse_vda5050_request(root, limits, work);
  if (!request) return std::nullopt;
  auto states = parse_states(root.require("messages"), *request);
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  return VdaImport{std::move(*request), std::move(states)};
}

namespace {

/// A vehicle that is nearer to its path is on it (metres): the pose_tolerance of POST /v1/advance by default.
constexpr double kBesidePath = 0.1;

/// Distances that differ by less are the same (metres): the earlier place counts.
constexpr double kSameDistance = 1e-9;

core::Position position_at(core::Actions actions, const core::ActionPlace& place) {
  if (place.action >= actions.size()) return actions.back().to.position;
  const core::Action& action = actions[place.action];
  return action.from.position + place.fraction * (action.to.position - action.from.position);
}

/// The place of these actions, from one to another, that is nearest to a position, where the path comes near
/// to it for the first time; the earliest one, if there are several. None if it does not come nearer than
/// kBesidePath.
std::optional<core::ActionPlace> nearest_place(core::Actions actions, const core::ActionPlace& from,
                                               const core::ActionPlace& to, const core::Position& position,
                                               core::Work& work) {
  constexpr std::size_t kWorkOfALook = 64;
  std::optional<core::ActionPlace> nearest;
  double least = (position_at(actions, from) - position).norm();
  if (least <= kBesidePath) nearest = from;
  least = std::min(least, kBesidePath);
  for (std::size_t k = from.action; k < actions.size() && k <= to.action; ++k) {
    if (work.met_after(kWorkOfALook)) break;
    const core::Position path = actions[k].to.position - actions[k].from.position;
    const double squared = path.squaredNorm();
    const double first = k == from.action ? from.fraction : 0.0;
    const double last = k == to.action ? to.fraction : 1.0;
    if (squared <= 0.0 || last <= first) continue;
    const double along = (position - actions[k].from.position).dot(path) / squared;
    const double fraction = std::clamp(along, first, last);
    const double distance = (actions[k].from.position + fraction * path - position).norm();
    if (distance < least - kSameDistance) {
      least = distance;
      nearest = core::place_of({0, k, fraction});
    }
    const core::Position end = actions[k].from.position + last * path;
    if (nearest && (end - position).norm() > kBesidePath) break;  // it may come back later
  }
  return nearest;
}

/// How far a vehicle is with its order.
class Tracker {
 public:
  Tracker(const VdaRequest& request, std::size_t robot, const VehicleState* state, core::Work& work)
      : request_(request),
        robot_(robot),
        state_(state),
        work_(work),
        progress_(request.progress[robot]),
        route_(request.routes[robot]),
        actions_(request.actions[robot]) {}

  /// It has an order that is not cancelled, or will have as soon as the message arrives.
  bool has_order() const { return progress_.order_id && !is_cancelled(); }

  bool is_cancelled() const {
    return state_ != nullptr && progress_.cancel_id && state_->ended_actions.contains(*progress_.cancel_id);
  }

  /// It knows the last message.
  bool has_accepted() const {
    return has_order() && is_of_order() && state_->update_id >= progress_.update_id;
  }

  /// It has done all that the plan has for it.
  bool has_arrived() const {
    if (actions_.empty() || route_.nodes.empty()) return true;
    const std::size_t last = route_.nodes.size() - 1;
    const RouteNode& end = route_.nodes.back();
    if (!has_order()) return !(progress_.at < (end.stops.empty() ? end.at : end.until));
    return is_of_order() && reached() == last && has_ended(last);
  }

  core::ActionPlace place() const {
    core::ActionPlace place = progress_.at;
    if (!has_order() || !is_of_order() || route_.nodes.empty()) return place;
    const auto node = reached();
    core::ActionPlace most = last_stand(actions_.first(committed()));
    if (node) {
      place = std::max(place, place_at(*node));
      const bool is_last = *node + 1 == route_.nodes.size();
      most = is_last ? place : route_.nodes[*node + 1].at;
    }
    const bool is_busy = node && !has_ended(*node);
    if (!state_->pose || is_busy || !(place < most)) return place;
    return nearest_place(actions_, place, most, state_->pose->position, work_).value_or(place);
  }

  /// The place that the vehicle may go to, its actions there included; not before `place`.
  core::ActionPlace released(const core::ActionPlace& place) const {
    const auto node = route_.node_of(progress_.last_released);
    return node ? std::max(place, route_.nodes[*node].until) : place;
  }

 private:
  bool is_of_order() const {
    return state_ != nullptr && progress_.order_id && state_->order_id == *progress_.order_id;
  }

  std::size_t committed() const {
    return route_.nodes.empty() ? 0 : std::min(route_.nodes.front().at.action, actions_.size());
  }

  /// The last node of the route that it has reached; none if it has not come to the first one yet.
  std::optional<std::size_t> reached() const {
    // A vehicle that has just taken an order may still report the last node of the one before.
    const bool is_stale = state_->next_sequence_id && *state_->next_sequence_id <= state_->last_sequence_id;
    return is_stale ? std::nullopt : route_.node_of(state_->last_sequence_id);
  }

  /// Where a vehicle is that stands at a node.
  core::ActionPlace place_at(std::size_t node) const {
    const RouteNode& at = route_.nodes[node];
    const bool is_of_base = node == 0 && request_.bases[robot_];
    const bool ended = has_ended(node);
    if (is_of_base) return ended ? at.at : last_stand(actions_.first(committed()));
    const core::ActionPlace before = node > 0 ? std::max(at.at, route_.nodes[node - 1].until) : at.at;
    return ended && !at.stops.empty() ? std::max(before, at.until) : before;
  }

  /// Whether all actions of a node have ended.
  bool has_ended(std::size_t node) const {
    const auto is_ended = [&](std::string_view id) { return state_->ended_actions.contains(id); };
    if (node == 0 && request_.bases[robot_]) {
      const JsonReader actions = request_.bases[robot_]->last.find("actions").array();
      // Bounded: the actions in the body.
      for (const JsonReader action : actions.items()) {
        if (!is_ended(action.find("actionId").string().value_or(""))) return false;
      }
      return true;
    }
    const std::size_t count = actions_of(request_, robot_, route_.nodes[node]).size();
    const OrderNames names(request_, robot_, *progress_.order_id);
    for (std::size_t k = 0; k < count; ++k) {
      if (!is_ended(names.action(route_.sequence_id(node), k))) return false;
    }
    return true;
  }

  const VdaRequest& request_;
  std::size_t robot_;
  const VehicleState* state_;  // null: it has not reported
  core::Work& work_;
  const OrderProgress& progress_;
  const Route& route_;
  core::Actions actions_;
};

/// Writes the answer list by list.
class StatesWriter {
 public:
  StatesWriter(const VdaImport& import, core::Work& work) : import_(import), work_(work) {
    for (std::size_t k = 0; k < import.states.size(); ++k) {
      if (work.met_after(kWorkOfARobot)) break;
      const auto& state = import.states[k];
      trackers_.emplace_back(import.request, k, state ? &*state : nullptr, work);
      places_.push_back(trackers_.back().place());
    }
  }

  std::string write() {
    json_.begin_object();
    write_list("states", [&](std::size_t robot) { write_state(robot); });
    write_list("poses", [&](std::size_t robot) { write_pose(robot); });
    write_list("progress", [&](std::size_t robot) { write_progress(robot); });
    write_list("vehicles", [&](std::size_t robot) { write_vehicle(robot); });
    json_.end_object();
    return json_.take();
  }

 private:
  // An entry of each list, in bytes of text.
  static constexpr std::size_t kWorkOfARobot = 512;

  template <typename Write>
  void write_list(std::string_view name, const Write& write) {
    json_.key(name).begin_array();
    for (std::size_t k = 0; k < places_.size() && !work_.met_after(kWorkOfARobot); ++k) write(k);
    json_.end_array();
  }

  const core::Actions& actions(std::size_t robot) const { return import_.request.actions[robot]; }
  const std::string& id(std::size_t robot) const { return import_.request.robots[robot].id; }

  /// Where the vehicle was measured; none if it does not tell.
  std::optional<core::Pose> pose(std::size_t robot) const {
    const auto& state = import_.states[robot];
    return state ? state->pose : std::nullopt;
  }

  void write_state(std::size_t robot) {
    if (actions(robot).empty()) return;
    const bool has_order = trackers_[robot].has_order();
    const auto measured = pose(robot);
    if (!has_order && !measured) return;
    const core::ActionPlace& place = places_[robot];
    json_.begin_object().member("robot", id(robot));
    write_place(json_, place);
    if (measured && (!has_order || matters(robot, *measured))) {
      json_.member("x", measured->position.x()).member("y", measured->position.y());
      // A vehicle on its way turns as it likes; one without an order begins with the heading that it has.
      if (!has_order) json_.member("theta", measured->theta);
    }
    if (has_order) {
      json_.key("released").begin_object();
      write_place(json_, trackers_[robot].released(place));
      json_.end_object();
    }
    json_.end_object();
  }

  /// Whether a pose tells more than the place: it is between two nodes, or beside the path.
  bool matters(std::size_t robot, const core::Pose& measured) const {
    const core::ActionPlace& place = places_[robot];
    return place.fraction > 0.0 ||
           (position_at(actions(robot), place) - measured.position).norm() > kBesidePath;
  }

  void write_pose(std::size_t robot) {
    const auto measured = pose(robot);
    if (!actions(robot).empty() || !measured) return;
    json_.begin_object().member("robot", id(robot)).member("x", measured->position.x());
    json_.member("y", measured->position.y()).member("theta", measured->theta).end_object();
  }

  void write_progress(std::size_t robot) {
    const OrderProgress& progress = import_.request.progress[robot];
    json_.begin_object().member("robot", id(robot));
    if (trackers_[robot].has_order()) {
      json_.member("order_id", *progress.order_id).member("order_update_id", progress.update_id);
      json_.member("last_released_sequence_id", progress.last_released);
      if (progress.cancel_id) json_.member("cancel_id", *progress.cancel_id);
    }
    write_place(json_, places_[robot]);
    json_.end_object();
  }

  void write_vehicle(std::size_t robot) {
    const auto& state = import_.states[robot];
    json_.begin_object().member("robot", id(robot));
    json_.member("accepted", trackers_[robot].has_accepted());
    json_.member("arrived", trackers_[robot].has_arrived());
    json_.member("failed", state && state->has_failed).end_object();
  }

  const VdaImport& import_;
  core::Work& work_;
  std::vector<Tracker> trackers_;          // by robot
  std::vector<core::ActionPlace> places_;  // by robot
  JsonWriter json_;
};

}  // namespace

std::optional<std::string> write_states(const VdaImport& import, core::Work& work) {
  std::string text = StatesWriter(import, work).write();
  return work.met() ? std::nullopt : std::optional(std::move(text));
}

}  // namespace fleetplan::api
