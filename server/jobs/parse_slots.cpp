#include "server/jobs/parse_slots.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fleetplan::server {

namespace {

/// The bytes that a core parses in a millisecond, from the body to the problem; an estimate.
constexpr std::size_t kBytesPerMs = 16 * 1024;

}  // namespace

/// A body that waits; guarded by the mutex.
struct ParseSlots::Waiting {
  const Body& body;
  Clock::time_point due;   // the end of its parsing if it had been alone
  Kind slot = Kind::none;  // its slot, or none yet
  std::condition_variable_any changed = {};
};

ParseSlots::Slot::Slot(ParseSlots& slots, Body body, const core::StopCondition& stop)
    : slots_(slots), body_(std::move(body)), kind_(slots.await(body_, stop)) {}

ParseSlots::Kind ParseSlots::await(const Body& body, const core::StopCondition& stop) {
  std::unique_lock lock(mutex_);
  if (const Kind kind = take(body); kind != Kind::none) return kind;
  Waiting waiting{body, Clock::now() + std::chrono::milliseconds(body.bytes / kBytesPerMs)};
  const auto place = waiting_.insert(waiting_.end(), &waiting);
  const auto come = [&] { return waiting.slot != Kind::none; };
  // Some libraries overflow when they wait until the end of time.
  if (stop.deadline() == Clock::time_point::max()) {
    waiting.changed.wait(lock, stop.stop_token(), come);
  } else {
    waiting.changed.wait_until(lock, stop.stop_token(), stop.deadline(), come);
  }
  if (!come()) waiting_.erase(place);
  return waiting.slot;
}

std::size_t ParseSlots::waiting() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

/// Takes a free slot for such a body and returns its kind; none if there is no free one. The mutex is locked.
ParseSlots::Kind ParseSlots::take(const Body& body) {
  Kind kind = Kind::none;
  if (free_ > 0) {
    --free_;
    kind = Kind::any;
  } else if (body.bytes <= kSmall && std::exchange(small_is_free_, false)) {
    kind = Kind::small;
  }
  if (kind != Kind::none) ++taken_[body.client];
  return kind;
}

void ParseSlots::Slot::release() {
  if (!has_slot()) return;
  slots_.give_back(std::exchange(kind_, Kind::none), body_);
}

void ParseSlots::give_back(Kind kind, const Body& body) {
  const std::lock_guard lock(mutex_);
  if (kind == Kind::any) {
    ++free_;
  } else {
    small_is_free_ = true;
  }
  const auto taken = taken_.find(body.client);
  if (--taken->second == 0) taken_.erase(taken);
  const auto place = next();
  if (place == waiting_.end()) return;
  Waiting& waiting = **place;
  waiting.slot = take(waiting.body);
  waiting_.erase(place);
  waiting.changed.notify_one();
}

/// Returns the body that gets a slot, while one is free. The mutex is locked.
std::list<ParseSlots::Waiting*>::iterator ParseSlots::next() {
  const auto rank = [&](const Waiting* waiting) {
    const auto taken = taken_.find(waiting->body.client);
    const bool fits = free_ > 0 || waiting->body.bytes <= kSmall;
    return std::tuple(!fits, taken == taken_.end() ? 0 : taken->second, waiting->due);
  };
  const auto first = std::min_element(waiting_.begin(), waiting_.end(),
                                      [&](const Waiting* a, const Waiting* b) { return rank(a) < rank(b); });
  const bool fits = first != waiting_.end() && !std::get<0>(rank(*first));
  return fits ? first : waiting_.end();
}

}  // namespace fleetplan::server
