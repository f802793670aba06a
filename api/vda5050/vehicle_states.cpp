#include <array>
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
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

}  // namespace fleetplan::api
