#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "api/json/json_reader.h"
#include "core/model/action.h"

namespace fleetplan::api {

struct ActionsOwner;

/// Joins the actions of a robot one after the other, in the map frame, and reports those that do not fit.
/// Differences up to core::kContactTolerance (metres, seconds, radians) are accepted and removed, so that the
/// core gets actions without gaps.
class ActionChain {
 public:
  explicit ActionChain(const ActionsOwner& owner);

  /// The action as it goes on from the one before. Faults are reported at `item`.
  core::Action append(core::Action action, const JsonReader& item);
  /// The next action could not be read: what follows it is not compared with what precedes it.
  void skip();

 private:
  void check_times(const core::Action& action, const JsonReader& item) const;
  void check_begin(const core::Action& action, const JsonReader& item) const;
  void check_type(const core::Action& action, const JsonReader& item) const;
  void check_speed(const core::Action& action, const JsonReader& item) const;
  void check_reverse(const core::Action& action, const JsonReader& item) const;
  core::Action joined(core::Action action) const;
  std::string name() const;

  std::optional<double> linear_speed_;
  std::optional<double> angular_speed_;
  std::optional<bool> may_reverse_;
  std::optional<double> now_ = 0.0;  // seconds; none: unknown, as is the pose
  std::optional<core::Pose> pose_;
  std::size_t count_ = 0;  // of the actions before
};

}  // namespace fleetplan::api
