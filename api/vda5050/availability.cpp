#include "api/vda5050/availability.h"

#include <string>
#include <string_view>

#include "api/json/errors.h"

namespace fleetplan::api {

namespace {

class ReasonsWriter {
 public:
  ReasonsWriter(JsonWriter& json, const OrderProgress& progress, const VehicleState* state,
                const OrderTracker& tracker)
      : json_(json), progress_(progress), state_(state), tracker_(tracker) {}

  void write() {
    json_.key("availability").begin_object().key("reasons").begin_array();
    if (state_ == nullptr) {
      add("not_reported", "There is no message of this vehicle.");
    } else {
      write_reasons();
    }
    json_.end_array().member("available", is_available_).end_object();
  }

 private:
  void add(std::string_view reason, const std::string& detail) {
    json_.begin_object().member("reason", reason).member("detail", detail).end_object();
    is_available_ = false;
  }

  void write_reasons() {
    if (!state_->is_readable) add("unreadable", "Its message has faults, see errors, and does not count.");
    write_control();
    write_position();
    if (state_->error)
      add("error", "It cannot go on: it reports the error " + in_quotes(*state_->error) + ".");
    if (state_->refusal) {
      add("order_refused", "It has refused the last message of order " + in_quotes(*progress_.order_id) +
                               ": it reports the error " + in_quotes(*state_->refusal) + ".");
    }
    if (state_->is_readable) write_order();
    write_actions();
  }

  void write_control() {
    if (state_->control != Control::fleet) {
      add("operating_mode", "Its operating mode is " + in_quotes(state_->operating_mode) +
                                ", not AUTOMATIC or SEMIAUTOMATIC: the fleet is not in control of it.");
    }
    if (state_->emergency_stop) {
      add("emergency_stop", "An emergency stop, " + in_quotes(*state_->emergency_stop) + ", is active.");
    }
    if (state_->has_field_violation) add("field_violation", "Its protective field is violated.");
    if (state_->is_paused) add("paused", "It is paused, by its button or by an instant action.");
  }

  void write_position() {
    if (!state_->is_localized) add("not_localized", "It does not know where it is.");
    if (!state_->other_map) return;
    add("other_map", "It is on the map " + in_quotes(*state_->other_map) + ", where its order is not.");
  }

  void write_order() {
    if (tracker_.end() == OrderEnd::cleared || tracker_.end() == OrderEnd::forgotten) {
      write_lost_order();
    } else if (progress_.order_id && tracker_.has_order()) {
      write_unknown_order();
    } else if (!progress_.order_id && state_->next_sequence_id && !state_->order_id.empty() &&
               state_->order_id != progress_.ended_order_id) {
      add("other_order",
          "It executes order " + in_quotes(state_->order_id) + ", which was not sent for this plan.");
    }
  }

  void write_lost_order() {
    const std::string order = in_quotes(*progress_.order_id);
    if (tracker_.end() == OrderEnd::forgotten) {
      add("restarted", "It has forgotten order " + order + ": it was restarted.");
    } else {
      add("order_cleared", "It has dropped order " + order + " before its end.");
    }
  }

  void write_unknown_order() {
    const std::string order = in_quotes(*progress_.order_id);
    if (state_->order_id.empty()) {
      add("order_unknown", "It has no order: " + order + " is on its way, or did not arrive.");
    } else if (state_->order_id != *progress_.order_id) {
      add("other_order", "It has order " + in_quotes(state_->order_id) + ": " + order +
                             " is on its way, or another sender has given it this one.");
    } else if (state_->update_id > progress_.update_id) {
      add("other_order", "It has update " + std::to_string(state_->update_id) + " of order " + order +
                             ", of which " + std::to_string(progress_.update_id) + " was the last one sent.");
    }
  }

  void write_actions() {
    if (tracker_.has_order() && !tracker_.failed_actions().empty()) {
      add("action_failed",
          "The action " + in_quotes(tracker_.failed_actions().front().id) + " at a goal has failed.");
    }
    if (state_->has_retriable_action) {
      add("action_retriable", "An action has failed; the vehicle waits for retry or skipRetry.");
    }
  }

  JsonWriter& json_;
  const OrderProgress& progress_;
  const VehicleState* state_;
  const OrderTracker& tracker_;
  bool is_available_ = true;
};

}  // namespace

void write_availability(JsonWriter& json, const OrderProgress& progress, const VehicleState* state,
                        const OrderTracker& tracker) {
  ReasonsWriter(json, progress, state, tracker).write();
}

}  // namespace fleetplan::api
