#pragma once

// Orders that vehicles have when a plan begins. What is released of them cannot be taken back: the new plan
// has to begin with it, and the update of the order continues it. Also what all messages of VDA 5050 have.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/json/faults.h"
#include "api/json/json_reader.h"
#include "core/execution/dependencies.h"
#include "core/execution/executed_actions.h"
#include "core/geometry/segment.h"
#include "core/model/robot.h"
#include "core/runtime/work.h"

namespace fleetplan::api {

/// The order that a vehicle has when its plan begins, by its last message.
struct OrderBase {
  std::string order_id;
  std::uint64_t update_id = 0;
  std::uint64_t sequence_id = 0;            // of the last node that is released
  JsonReader last;                          // this node, as it was sent
  std::vector<core::Position> still_to_do;  // the released nodes that the vehicle has not reached, in order
};

/// Reads `base`: of each robot at most one order, and the state of its vehicle. Returns them by robot.
std::vector<std::optional<OrderBase>> parse_bases(const JsonReader& member,
                                                  const std::vector<core::Robot>& robots);

/// Returns the place in these actions from which on the robot stands.
core::ActionPlace last_stand(core::Actions actions);

/// Returns why an order cannot be continued by a plan, as a sentence; none if it can. It can if the robot is
/// committed to go past all that is still to do, and its committed motion ends there; and if it does not have
/// to wait for anybody on the way. `closed`: the first gate of the plan that is closed for the robot.
std::optional<std::string> why_it_ends(const OrderBase& base, const core::Robot& robot, core::Actions actions,
                                       const core::ActionPlace& closed, core::Work& stop);

/// Ids of updates and sequences are unsigned numbers of 32 bits, and there is one after each.
inline constexpr std::uint64_t kGreatestId = 4'294'967'294;

/// Returns the value itself if it is an object; otherwise an absent one. Messages may have more members than
/// are known here.
inline JsonReader message(const JsonReader& value) {
  if (!value || value.value().is_object()) return value;
  value.must_be(fault::kWrongType, "an object");
  return {};
}

}  // namespace fleetplan::api
