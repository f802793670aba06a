#pragma once

// State messages of VDA 5050 2.0 to 3.0. Each message is judged alone. A message with faults does not count,
// and its faults are told.

#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/vda5050/export.h"
#include "core/geometry/position.h"

namespace fleetplan::api {

/// Who controls a vehicle, by its operating mode.
enum class Control : std::uint8_t {
  fleet,     // AUTOMATIC, SEMIAUTOMATIC
  operators  // any other mode
};

/// A state message of a vehicle, with the members that matter here. Texts refer to the body.
struct VehicleState {
  bool is_readable = false;   // it has no faults; otherwise what follows may be incomplete
  std::string_view order_id;  // empty: it has had no order
  std::uint64_t update_id = 0;
  std::optional<std::uint64_t> next_sequence_id = {};  // of the first node that it still has to reach
  std::optional<std::uint64_t> last_sequence_id = {};  // of the last node that it has reached
  std::optional<core::Pose> pose = {};                 // none: it does not tell, or cannot know
  bool is_localized = true;
  std::optional<std::string_view> other_map = {};              // it is on this one, where its order is not
  std::unordered_set<std::string_view> finished_actions = {};  // by id
  std::unordered_set<std::string_view> failed_actions = {};
  bool has_retriable_action = false;

  Control control = Control::fleet;
  std::string_view operating_mode = {};
  bool clears_orders = false;  // in this operating mode, vehicles drop their orders
  bool has_no_nodes = false;   // it says that there is no node that it still has to reach
  bool is_idle = false;        // it says that it does not drive, and has no edge
  bool is_paused = false;
  bool has_field_violation = false;
  std::optional<std::string_view> emergency_stop = {};
  std::optional<std::string_view> error = {};    // the type of an error with which it cannot go on
  std::optional<std::string_view> refusal = {};  // the type of the error: it has refused the last message
  bool has_no_order_to_cancel = false;           // although it was told to cancel the order
};

/// What is reported of a robot.
struct VehicleReport {
  std::optional<VehicleState> state;  // none: there is no message of its vehicle
  FaultList faults;                   // of its messages
};

struct VehicleReports {
  std::vector<VehicleReport> of_robots;
  FaultList of_strangers;  // faults of messages whose sender is no robot
};

/// Reads `messages`. If a vehicle has several, the newest counts. Their faults are not faults of the
/// document.
VehicleReports parse_reports(const JsonReader& member, const VdaRequest& request);

}  // namespace fleetplan::api
