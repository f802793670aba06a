#include "server/jobs/parse_slots.h"

#include <algorithm>
#include <utility>

namespace fleetplan::server {

/// A body that waits; guarded by the mutex.
struct ParseSlots::Waiting {
  std::size_t bytes;
  Slot::Kind slot = Slot::Kind::none;  // once it has one
  std::condition_variable_any changed = {};
};

ParseSlots::Slot::Slot(ParseSlots& slots, std::size_t bytes, const core::StopCondition& stop)
    : slots_(slots) {
  std::unique_lock lock(slots_.mutex_);
  kind_ = take(slots_.free_, bytes);
  if (has_slot()) return;
  Waiting waiting{bytes};
  const auto larger = std::find_if(slots_.waiting_.begin(), slots_.waiting_.end(),
                                   [&](const Waiting* other) { return other->bytes > bytes; });
  const auto place = slots_.waiting_.insert(larger, &waiting);
  const auto come = [&] { return waiting.slot != Kind::none; };
  // Some libraries overflow when they wait until the end of time.
  if (stop.deadline() == core::StopCondition::Clock::time_point::max()) {
    waiting.changed.wait(lock, stop.stop_token(), come);
  } else {
    waiting.changed.wait_until(lock, stop.stop_token(), stop.deadline(), come);
  }
  kind_ = waiting.slot;
  if (!has_slot()) slots_.waiting_.erase(place);
}

ParseSlots::Slot::Kind ParseSlots::Slot::take(Free& free, std::size_t bytes) {
  if (free.any > 0) {
    --free.any;
    return Kind::any;
  }
  if (bytes <= kSmall && std::exchange(free.small, false)) return Kind::small;
  return Kind::none;
}

void ParseSlots::Slot::release() {
  if (!has_slot()) return;
  const std::lock_guard lock(slots_.mutex_);
  if (kind_ == Kind::any) {
    ++slots_.free_.any;
  } else {
    slots_.free_.small = true;
  }
  kind_ = Kind::none;
  if (slots_.waiting_.empty()) return;
  Waiting& next = *slots_.waiting_.front();  // the smallest: no other can use what it cannot
  next.slot = take(slots_.free_, next.bytes);
  if (next.slot == Kind::none) return;
  slots_.waiting_.pop_front();
  next.changed.notify_one();
}

}  // namespace fleetplan::server
