#pragma once

// The parts of a robot of the request that an answer repeats.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/json/faults.h"
#include "api/request/shared_members.h"
#include "core/model/action.h"

namespace fleetplan::api {

/// The actions of a request as they were received, in the world and with their headings as given. Only those
/// are kept that the core's numbers do not give back: the map's origin rounds them, or they were joined to
/// the action before.
class ReceivedMotion {
 public:
  /// Keeps an action by its index; indices ascend.
  void keep(std::size_t index, const core::Action& world) { kept_.push_back({index, world}); }

  /// Returns the action as received, or null if the core's numbers give it back.
  const core::Action* find(std::size_t index) const {
    const auto found =
        std::lower_bound(kept_.begin(), kept_.end(), index,
                         [](const Kept& kept, std::size_t wanted) { return kept.index < wanted; });
    return found != kept_.end() && found->index == index ? &found->world : nullptr;
  }

 private:
  struct Kept {
    std::size_t index;
    core::Action world;
  };
  std::vector<Kept> kept_;
};

/// What the answer needs to know about a robot of the request beside the core's robot.
struct ReceivedRobot {
  ReceivedMotion committed;
  ReceivedMotion previous;
  bool lists_visits = false;               // its plan tells when each goal is visited
  std::vector<Fault> errors;               // why it is invalid; empty if it is not
  std::string metadata = {};               // of the robot, see parse_metadata
  std::vector<GoalTexts> goal_texts = {};  // by goal, as in ParsedGoals
  /// By goal: the number of the pose of `any_of` that the plan goes to; none for a goal without. Shorter if
  /// the last ones have none.
  std::vector<std::optional<std::size_t>> choices = {};
};

}  // namespace fleetplan::api
