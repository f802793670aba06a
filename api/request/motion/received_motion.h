#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/model/action.h"

namespace fleetplan::api {

/// The actions of a request as they were received, in the world and with their headings as given. Only those
/// are kept that the core's numbers do not give back: the map's origin rounds them, or they were joined to
/// the action before.
class ReceivedMotion {
 public:
  /// `index`: of the action; ascending.
  void keep(std::size_t index, const core::Action& world) { kept_.push_back({index, world}); }

  /// The action as received, or null if the core's numbers give it back.
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

}  // namespace fleetplan::api
