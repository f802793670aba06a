#include "api/vda5050/import.h"

#include <string>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/request/limits.h"
#include "api/vda5050/availability.h"
#include "api/vda5050/order_tracker.h"

namespace fleetplan::api {

std::optional<VdaImport> parse_vda5050_import(const JsonReader& root, const Limits& limits,
                                              core::Work& work) {
  auto request = parse_vda5050_request(root, limits, work);
  if (!request) return std::nullopt;
  auto reports = parse_reports(root.require("messages").array(), *request);
  if (root.fault_count() > 0 || work.met()) return std::nullopt;
  return VdaImport{std::move(*request), std::move(reports)};
}

namespace {

/// Writes the answer list by list.
class StatesWriter {
 public:
  StatesWriter(const VdaImport& import, core::Work& work) : import_(import), work_(work) {
    const std::size_t robots = import.request.robots.size();
    trackers_.reserve(robots);
    for (std::size_t k = 0; k < robots; ++k) {
      if (work.met_after(kWorkOfARobot)) break;
      trackers_.emplace_back(import.request, k, state(k), work);
      places_.push_back(trackers_.back().place());
    }
  }

  std::string write() {
    json_.begin_object();
    write_list("states", [&](std::size_t robot) { write_state(robot); });
    write_list("poses", [&](std::size_t robot) { write_pose(robot); });
    write_list("progress", [&](std::size_t robot) { write_progress(robot); });
    write_list("vehicles", [&](std::size_t robot) { write_vehicle(robot); });
    write_faults(import_.reports.of_strangers);
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

  /// What the vehicle has reported; null if there is no message of it.
  const VehicleState* state(std::size_t robot) const {
    const auto& state = import_.reports.of_robots[robot].state;
    return state ? &*state : nullptr;
  }

  /// Where the vehicle was measured; none if it does not tell. While it starts, nothing is sure.
  std::optional<core::Pose> pose(std::size_t robot) const {
    const VehicleState* reported = state(robot);
    if (reported == nullptr || !reported->is_readable) return std::nullopt;
    return reported->operating_mode == "STARTUP" ? std::nullopt : reported->pose;
  }

  void write_state(std::size_t robot) {
    if (actions(robot).empty()) return;
    const bool has_order = trackers_[robot].has_order();
    const auto measured = pose(robot);
    if (!has_order && state(robot) == nullptr) return;
    const core::ActionPlace place = trackers_[robot].place_to_plan_from(places_[robot]);
    json_.begin_object().member("robot", id(robot));
    write_place(json_, place);
    // A vehicle that has gone on after an action has failed is somewhere on the way that is released for it.
    const bool is_beyond = place < places_[robot];
    if (measured && (!has_order || (!is_beyond && matters(robot, place, *measured)))) {
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
  bool matters(std::size_t robot, const core::ActionPlace& place, const core::Pose& measured) const {
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
    const auto& ended = progress.order_id ? progress.order_id : progress.ended_order_id;
    if (!trackers_[robot].has_order()) {
      if (ended) json_.member("ended_order_id", *ended);
    } else {
      json_.member("order_id", *progress.order_id).member("order_update_id", progress.update_id);
      json_.member("last_released_sequence_id", progress.last_released);
      if (progress.cancel_id) json_.member("cancel_id", *progress.cancel_id);
    }
    if (trackers_[robot].served() > 0) json_.member("served", trackers_[robot].served());
    write_place(json_, places_[robot]);
    json_.end_object();
  }

  void write_vehicle(std::size_t robot) {
    const OrderTracker& tracker = trackers_[robot];
    const VehicleState* reported = state(robot);
    const bool cannot_go_on = reported != nullptr && (reported->error || reported->refusal);
    const bool has_failed = cannot_go_on || (tracker.has_order() && !tracker.failed_actions().empty());
    json_.begin_object().member("robot", id(robot));
    json_.member("accepted", tracker.has_accepted()).member("arrived", tracker.has_arrived());
    json_.member("failed", has_failed);
    write_availability(json_, import_.request.progress[robot], reported, tracker);
    write_failed_actions(tracker);
    write_faults(import_.reports.of_robots[robot].faults);
    json_.end_object();
  }

  void write_failed_actions(const OrderTracker& tracker) {
    json_.key("failed_actions").begin_array();
    if (tracker.has_order()) {
      for (const FailedAction& action : tracker.failed_actions()) {
        json_.begin_object().member("action_id", action.id);
        if (action.goal) json_.member("goal", *action.goal);
        json_.end_object();
      }
    }
    json_.end_array();
  }

  void write_faults(const FaultList& faults) {
    json_.key("errors").begin_array();
    for (const Fault& fault : faults.listed()) {
      json_.begin_object().member("pointer", fault.pointer).member("code", fault.code);
      json_.member("detail", fault.detail).end_object();
    }
    json_.end_array().member("errors_total", faults.count());
  }

  const VdaImport& import_;
  core::Work& work_;
  std::vector<OrderTracker> trackers_;     // by robot
  std::vector<core::ActionPlace> places_;  // by robot
  JsonWriter json_;
};

}  // namespace

std::optional<std::string> write_states(const VdaImport& import, core::Work& work) {
  std::string text = StatesWriter(import, work).write();
  return work.met() ? std::nullopt : std::optional(std::move(text));
}

}  // namespace fleetplan::api
