#include "api/vda5050/vehicle_state.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "api/request/limits.h"
#include "core/geometry/segment.h"

namespace fleetplan::api {

namespace {

template <std::size_t kCount>
bool is_one_of(std::string_view text, const std::array<std::string_view, kCount>& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

constexpr std::array<std::string_view, 2> kFleetModes{"AUTOMATIC", "SEMIAUTOMATIC"};
// TEACH_IN and STARTUP from 3.0.0 on. A vehicle that is INTERVENED keeps its order.
constexpr std::array<std::string_view, 5> kClearingModes{"MANUAL", "SERVICE", "TEACHIN", "TEACH_IN",
                                                         "STARTUP"};
constexpr std::array<std::string_view, 2> kStoppingLevels{"FATAL", "CRITICAL"};

/// The types of errors that say that a message was refused, up to 2.1 and from 3.0.0 on.
constexpr std::array<std::string_view, 17> kRefusals{"validationError",
                                                     "orderError",
                                                     "orderUpdateError",
                                                     "noRouteError",
                                                     "VALIDATION_FAILURE",
                                                     "UNSUPPORTED_PARAMETER",
                                                     "INVALID_ORDER",
                                                     "INVALID_ORDER_ACTION",
                                                     "OUTDATED_ORDER_UPDATE",
                                                     "SAME_ORDER_UPDATE_ID",
                                                     "ORDER_UPDATE_FOLLOWING_CANCEL",
                                                     "INSUFFICIENT_MEMORY",
                                                     "NO_ROUTE_TO_TARGET",
                                                     "OTHER_ORDER_ACTIVE",
                                                     "START_NODE_OUT_OF_RANGE",
                                                     "MOBILE_ROBOT_NOT_AVAILABLE",
                                                     "UNKNOWN_MAP_ID"};
constexpr std::array<std::string_view, 2> kNothingToCancel{"noOrderToCancel", "NO_ORDER_TO_CANCEL"};

/// Returns a member that may be absent or null, which is the same.
JsonReader optional_of(const JsonReader& json, std::string_view key) {
  const JsonReader member = json.find(key);
  return member.is_null() ? JsonReader() : member;
}

/// Returns a string of any length; anything else is a fault.
std::optional<std::string_view> text_of(const JsonReader& value) {
  if (value && !value.string()) value.must_be(fault::kWrongType, "a string");
  return value.string();
}

/// What the references of an error say of an order.
struct References {
  enum class To : std::uint8_t { nothing, this_one, another };
  To order = To::nothing;
  To update = To::nothing;
  To cancellation = To::nothing;
};

class StateReader {
 public:
  StateReader(const JsonReader& json, const VdaRequest& request, std::size_t robot)
      : json_(json),
        progress_(request.progress[robot]),
        route_(request.routes[robot]),
        map_id_(request.vehicles[robot].map_id) {}

  VehicleState read() {
    const std::size_t before = json_.fault_count();
    read_order();
    read_nodes();
    read_control();
    for (const std::string_view name : {"agvPosition", "mobileRobotPosition"}) {  // from 3.0.0 on the second
      read_position(message(optional_of(json_, name)));
    }
    // Bounded: the items of two lists in the body.
    for (const std::string_view list : {"actionStates", "instantActionStates"}) {
      for (const JsonReader item : optional_of(json_, list).array().items()) read_action(message(item));
    }
    for (const JsonReader item : optional_of(json_, "errors").array().items()) read_error(message(item));
    state_.is_readable = json_.fault_count() == before;
    return std::move(state_);
  }

 private:
  bool is_of_order() const { return progress_.order_id && state_.order_id == *progress_.order_id; }
  bool has_accepted() const { return is_of_order() && state_.update_id == progress_.update_id; }

  void read_order() {
    state_.order_id = text_of(json_.require("orderId")).value_or("");
    state_.update_id = json_.require("orderUpdateId").natural(kGreatestId).value_or(0);
    const auto last_node = text_of(optional_of(json_, "lastNodeId"));
    if (!last_node || last_node->empty()) return;  // then the number means nothing
    state_.last_sequence_id = json_.require("lastNodeSequenceId").natural(kGreatestId);
  }

  void read_nodes() {
    const JsonReader nodes = optional_of(json_, "nodeStates").array();
    for (const JsonReader item : nodes.items()) {
      const auto sequence_id = message(item).require("sequenceId").natural(kGreatestId);
      if (sequence_id && !state_.next_sequence_id) state_.next_sequence_id = sequence_id;
    }
    state_.has_no_nodes = nodes && nodes.size() == 0;
    const JsonReader edges = optional_of(json_, "edgeStates").array();
    const auto drives = optional_of(json_, "driving").boolean();
    state_.is_idle = edges && edges.size() == 0 && drives == false;
    if (is_of_order()) judge_last_node();
  }

  /// A vehicle cannot have reached what is not released.
  void judge_last_node() const {
    const auto& last = state_.last_sequence_id;
    // A vehicle that has just taken an order may still report the last node of the previous order.
    const bool is_earlier = !last || (state_.next_sequence_id && *state_.next_sequence_id <= *last);
    if (is_earlier || (*last < route_.first_sequence_id && *last % 2 == 0)) return;
    if (*last <= progress_.last_released && route_.node_of(*last)) return;
    json_.find("lastNodeSequenceId").must_be(fault::kOutOfRange, [&] {
      return "that of a released node of order " + in_quotes(state_.order_id) + ", " +
             std::to_string(progress_.last_released) + " at most";
    });
  }

  void read_control() {
    const auto mode = text_of(optional_of(json_, "operatingMode"));
    state_.operating_mode = mode.value_or("");
    if (mode && !is_one_of(*mode, kFleetModes)) state_.control = Control::operators;
    state_.clears_orders = is_one_of(state_.operating_mode, kClearingModes);
    state_.is_paused = optional_of(json_, "paused").boolean().value_or(false);
    const JsonReader safety = message(optional_of(json_, "safetyState"));
    state_.has_field_violation = optional_of(safety, "fieldViolation").boolean().value_or(false);
    for (const std::string_view name : {"eStop", "activeEmergencyStop"}) {  // from 3.0.0 on the second
      const auto stop = text_of(optional_of(safety, name));
      if (stop && *stop != "NONE" && !stop->empty()) state_.emergency_stop = stop;
    }
  }

  /// A pose that the vehicle does not trust itself, or of another map, is not even read.
  void read_position(const JsonReader& position) {
    if (!position || has_position_) return;
    has_position_ = true;
    const auto is_initialized = optional_of(position, "positionInitialized").boolean();
    const auto is_localized = optional_of(position, "localized").boolean();
    state_.is_localized = is_initialized != false && is_localized != false;
    const auto map = text_of(optional_of(position, "mapId"));
    if (map && *map != map_id_) state_.other_map = map;
    if (!state_.is_localized || state_.other_map) return;
    const auto x = position.require("x").number(kCoordinate);
    const auto y = position.require("y").number(kCoordinate);
    const auto theta = position.require("theta").number(kAnyAngle);
    if (x && y && theta) state_.pose = core::Pose{{*x, *y}, core::normalize_angle(*theta)};
  }

  void read_action(const JsonReader& action) {
    const auto id = text_of(action.require("actionId"));
    const auto status = text_of(action.require("actionStatus"));
    if (!id || !status) return;
    if (*status == "FINISHED") state_.finished_actions.insert(*id);
    if (*status == "FAILED") state_.failed_actions.insert(*id);
    if (*status == "RETRIABLE") state_.has_retriable_action = true;
  }

  void read_error(const JsonReader& error) {
    const auto level = text_of(error.require("errorLevel"));
    const auto type = optional_of(error, "errorType").string().value_or("");
    if (level && is_one_of(*level, kStoppingLevels)) state_.error = type;
    const References references = references_of(error);
    if (is_refusal(type, references)) state_.refusal = type;
    if (is_one_of(type, kNothingToCancel) && references.cancellation != References::To::another) {
      state_.has_no_order_to_cancel = true;
    }
  }

  References references_of(const JsonReader& error) const {
    References references;
    for (const JsonReader item : optional_of(error, "errorReferences").array().items()) {
      const JsonReader reference = message(item);
      const auto key = reference.find("referenceKey").string().value_or("");
      const JsonReader value = reference.find("referenceValue");
      const auto number = value.natural();  // the standard has strings
      const std::string text = number ? std::to_string(*number) : std::string(value.string().value_or(""));
      const auto meant = [&](bool is_this) {
        return is_this ? References::To::this_one : References::To::another;
      };
      if (key == "orderId") references.order = meant(text == progress_.order_id);
      if (key == "orderUpdateId") references.update = meant(text == std::to_string(progress_.update_id));
      if (key == "actionId") references.cancellation = meant(text == progress_.cancel_id);
    }
    return references;
  }

  /// Whether an error says that the last message was refused. It must refer to the order and its update, or
  /// to the order alone. In the second case, the vehicle does not have the order at all, unless the type says
  /// that the error is about a message. An error that refers to something else is about that.
  bool is_refusal(std::string_view type, const References& references) const {
    using To = References::To;
    if (!progress_.order_id || references.order == To::another || references.update == To::another) {
      return false;
    }
    if (references.order == To::this_one && references.update == To::this_one) return true;
    if (has_accepted()) return false;
    return is_one_of(type, kRefusals) || (references.order == To::this_one && !is_of_order());
  }

  JsonReader json_;
  const OrderProgress& progress_;
  const Route& route_;
  const std::string& map_id_;
  VehicleState state_;
  bool has_position_ = false;
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

  /// The robot of a message; none if it is a fault. Only where several makes have its serial number, the
  /// manufacturer counts.
  std::optional<std::size_t> find(const JsonReader& message) const {
    const JsonReader member = message.require("serialNumber");
    const auto serial = member.name();
    if (!serial) return std::nullopt;
    if (!of_several_makes_.contains(*serial)) {
      if (const auto robot = robots_.find(*serial); robot != robots_.end()) return robot->second;
      member.fault(fault::kUnknownRobot,
                   [&] { return "There is no robot with the serial number " + in_quotes(*serial) + "."; });
      return std::nullopt;
    }
    const JsonReader make = message.require("manufacturer", ", as several makes have this serial number");
    const auto name = make.name();
    if (!name) return std::nullopt;
    const auto robot = robots_of_makes_.find({*name, *serial});
    if (robot != robots_of_makes_.end()) return robot->second;
    make.fault(fault::kUnknownRobot, [&] {
      return "There is no robot of this manufacturer with the serial number " + in_quotes(*serial) + ".";
    });
    return std::nullopt;
  }

 private:
  std::unordered_map<std::string, std::size_t> robots_;  // by serial number, the first of several
  std::unordered_set<std::string> of_several_makes_;     // serial numbers
  std::map<std::pair<std::string, std::string>, std::size_t> robots_of_makes_;  // by manufacturer and number
};

/// Returns a time in UTC in a form that sorts as the time does; empty if it is none.
std::string_view sortable_time(const JsonReader& message) {
  std::string_view text = message.find("timestamp").string().value_or("");
  if (!is_timestamp(text)) return {};
  text.remove_suffix(1);
  return text;
}

/// Whether a message is newer than an earlier message in the list.
bool is_newer(const JsonReader& later, const JsonReader& earlier) {
  const std::string_view time = sortable_time(later);
  const std::string_view other_time = sortable_time(earlier);
  if (!time.empty() && !other_time.empty() && time != other_time) return time > other_time;
  const auto id = later.find("headerId").natural();
  const auto other_id = earlier.find("headerId").natural();
  return !id || !other_id || *id >= *other_id;
}

/// A message, and its place in the list.
struct Message {
  JsonReader json;
  std::size_t index = 0;
};

void add_unused(const Message& message, FaultList& faults) {
  faults.add(message.json.value().begins(), [&] {
    return Fault{"/messages/" + std::to_string(message.index), fault::kDuplicate,
                 "There is a newer message of this vehicle, so this one does not count."};
  });
}

}  // namespace

VehicleReports parse_reports(const JsonReader& member, const VdaRequest& request) {
  const Senders senders(request.vehicles);
  VehicleReports reports;
  reports.of_robots.resize(request.robots.size());
  std::vector<Message> newest(request.robots.size());
  reports.of_strangers = member.faults_of([&] {
    std::size_t index = 0;
    // Bounded: the messages in the body.
    for (const JsonReader item : member.items()) {
      Message next{message(item), index++};
      const auto robot = senders.find(next.json);
      if (!robot) continue;
      Message& best = newest[*robot];
      if (!best.json || is_newer(next.json, best.json)) std::swap(next, best);
      if (next.json) add_unused(next, reports.of_robots[*robot].faults);
    }
  });
  for (std::size_t k = 0; k < newest.size(); ++k) {
    const Message& last = newest[k];
    if (!last.json) continue;
    VehicleReport& report = reports.of_robots[k];
    FaultList faults = last.json.faults_of([&] { report.state = StateReader(last.json, request, k).read(); });
    // To find the place of a fault takes a look at each message before it.
    const std::size_t described = std::min(faults.count(), FaultList::kMaxListed);
    report.faults.add_all(std::move(faults));
    if (member.work().met_after(described * last.index)) break;
  }
  return reports;
}

}  // namespace fleetplan::api
