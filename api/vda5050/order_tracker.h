#pragma once

// How far a vehicle is with its order, by its reports.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/vda5050/export.h"
#include "api/vda5050/route.h"
#include "api/vda5050/vehicle_state.h"
#include "core/execution/executed_actions.h"
#include "core/runtime/stop_condition.h"

namespace fleetplan::api {

/// A vehicle that is nearer to its path than this is on its path (metres). Equals the default pose_tolerance
/// of POST /v1/advance.
inline constexpr double kBesidePath = 0.1;

/// Returns the position of a robot at a place of its actions. There must be actions.
core::Position position_at(core::Actions actions, const core::ActionPlace& place);

/// Why a vehicle no longer has an order that it was given.
enum class OrderEnd : std::uint8_t { none, cancelled, cleared, forgotten };

/// An action at a goal that has failed.
struct FailedAction {
  std::string id;
  std::optional<std::size_t> goal = {};      // none: it is none of the plan
  std::optional<core::ActionPlace> at = {};  // where the service of this goal begins
};

/// The first goals whose actions are finished, as far as the actions of an order were examined.
struct FinishedGoals {
  std::size_t count = 0;
  bool are_all = true;  // no action that was looked at is not finished
};

/// Says what the report of a robot's vehicle means for its plan. A report counts if all of these hold:
///
/// - Nothing in it is at fault.
/// - It is about the order as it was sent.
/// - The vehicle knows where it is, on the map of its order, and is under the control of the fleet.
///
/// Without such a report, the request's progress holds, except for the goals that are served. What a vehicle
/// says about its actions is true wherever it is, and opens no gates.
class OrderTracker {
 public:
  /// `state`: null if it has not reported.
  OrderTracker(const VdaRequest& request, std::size_t robot, const VehicleState* state, core::Work& work);

  /// Whether it has an order, or will have one as soon as the message arrives.
  bool has_order() const { return progress_.order_id && end_ == OrderEnd::none; }
  /// Why it has none any more.
  OrderEnd end() const { return end_; }
  /// It knows the last message.
  bool has_accepted() const { return has_order() && is_up_to_date(); }
  /// Whether it has done everything that its plan contains.
  bool has_arrived() const;
  /// The place that it has reached; never before the place in the request.
  core::ActionPlace place() const;
  /// How many of its goals are served; these are its first goals.
  std::size_t served() const { return served_; }
  /// The place from which on a plan has to go on. It is after the goals that are served, but not after a goal
  /// whose actions have failed.
  core::ActionPlace place_to_plan_from(const core::ActionPlace& place) const;
  /// The place that the vehicle may go to, including its actions there; not before `place`.
  core::ActionPlace released(const core::ActionPlace& place) const;
  const std::vector<FailedAction>& failed_actions() const { return failed_; }

 private:
  enum class Outcome : std::uint8_t { under_way, failed, done };

  bool is_of_order() const;
  bool is_up_to_date() const { return is_of_order() && state_->update_id == progress_.update_id; }
  bool counts() const;
  bool is_at_rest_at_end() const;
  OrderEnd find_end() const;
  bool is_cancelled() const;
  bool is_cleared() const;
  bool is_forgotten() const;
  void find_failed_actions();
  void find_failed_actions_of_base();
  std::size_t goals_before_failure() const;
  FinishedGoals find_served_goals() const;
  FinishedGoals find_served_goals_of_base() const;
  core::ActionPlace behind_served_goals() const;
  std::size_t committed() const;
  std::optional<std::size_t> reached() const;
  core::ActionPlace arrival_at(std::size_t node) const;
  core::ActionPlace place_at(std::size_t node) const;
  bool is_of_base(std::size_t node) const { return node == 0 && request_.bases[robot_].has_value(); }
  std::vector<std::string> action_ids(std::size_t node) const;
  Outcome outcome(std::size_t node) const;

  const VdaRequest& request_;
  std::size_t robot_;
  const VehicleState* state_;
  core::Work& work_;
  const OrderProgress& progress_;
  const Route& route_;
  core::Actions actions_;
  OrderEnd end_ = OrderEnd::none;
  std::vector<FailedAction> failed_;
  std::size_t served_ = 0;
};

}  // namespace fleetplan::api
