#include <array>
#include <string>
#include <unordered_map>
#include <utility>

#include "api/json/faults.h"
#include "api/request/ranges.h"
#include "api/vda5050/import.h"
#include "api/vda5050/messages.h"
#include "core/geometry/angle.h"

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

}  // namespace

std::vector<std::optional<VehicleState>> parse_states(const JsonReader& member, const VdaRequest& request) {
  std::unordered_map<std::string_view, std::size_t> robots;
  for (std::size_t k = 0; k < request.vehicles.size(); ++k) {
    robots.emplace(request.vehicles[k].serial_number, k);
  }
  std::vector<std::optional<VehicleState>> states(request.robots.size());
  // Bounded: the messages in the body.
  for (const JsonReader item : member.array().items()) {
    const JsonReader json = message(item);
    const JsonReader serial = json.require("serialNumber");
    const auto name = serial.name();
    if (!name) continue;
    const auto robot = robots.find(*name);
    if (robot == robots.end()) {
      serial.fault(fault::kUnknownRobot,
                   [&] { return "There is no robot with the serial number " + in_quotes(*name) + "."; });
    } else if (states[robot->second]) {
      serial.fault(fault::kDuplicate, "There are two messages of this vehicle; give the last one.");
    } else {
      states[robot->second] = StateReader(json, request.progress[robot->second]).read();
    }
  }
  return states;
}

}  // namespace fleetplan::api
