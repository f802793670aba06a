#include "server/jobs/parse_slots.h"

#include <algorithm>
#include <utility>

namespace fleetplan::server {

/// A body that waits; guarded by the mutex.
struct ParseSlots::Waiting {
  std::size_t bytes;
  Kind slot = Kind::none;  // once it has one
  std::condition_variable_any changed = {};
};

ParseSlots::Slot::Slot(ParseSlots& slots, std::size_t bytes, const core::StopCondition& stop)
    : slots_(slots), kind_(slots.await(bytes, stop)) {}

ParseSlots::Kind ParseSlots::await(std::size_t bytes, const core::StopCondition& stop) {
  std::unique_lock lock(mutex_);
  if (const Kind kind = take(bytes); kind != Kind::none) return kind;
  Waiting waiting{bytes};
  const auto larger = std::find_if(waiting_.begin(), waiting_.end(),
                                   [&](const Waiting* other) { return other->bytes > bytes; });
  const auto place = waiting_.insert(larger, &waiting);
  const auto come = [&] { return waiting.slot != Kind::none; };
  // Some libraries overflow when they wait until the end of time.
  if (stop.deadline() == core::StopCondition::Clock::time_point::max()) {
    waiting.changed.wait(lock, stop.stop_token(), come);
  } else {
    waiting.changed.wait_until(lock, stop.stop_token(), stop.deadline(), come);
  }
  if (!come()) waiting_.erase(place);
  return waiting.slot;
}

/// With the mutex locked: a free slot for such a body, which is taken.
ParseSlots::Kind ParseSlots::take(std::size_t bytes) {
  if (free_ > 0) {
    --free_;
    return Kind::any;
  }
  if (bytes <= kSmall && std::exchange(small_is_free_, false)) return Kind::small;
  return Kind::none;
}

void ParseSlots::Slot::release() {
  if (!has_slot()) return;
  slots_.give_back(std::exchange(kind_, Kind::none));
}

void ParseSlots::give_back(Kind kind) {
  const std::lock_guard lock(mutex_);
  if (kind == Kind::any) {
    ++free_;
  } else {
    small_is_free_ = true;
  }
  if (waiting_.empty()) return;
  Waiting& next = *waiting_.front();  // the smallest: no other can use what it cannot
  next.slot = take(next.bytes);
  if (next.slot == Kind::none) return;
  waiting_.pop_front();
  next.changed.notify_one();
}

}  // namespace fleetplan::server
