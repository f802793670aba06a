#include "server/jobs/parse_slots.h"

#include <algorithm>
#include <chrono>
#include <tuple>
#include <utility>

namespace fleetplan::server {

namespace {

/// The bytes that a core parses in a millisecond, from the body to the problem; an estimate.
constexpr std::size_t kBytesPerMs = 16 * 1024;

}  // namespace

ParseSchedule::Waiting::Waiting(const Body& waiting, Time arrived)
    : body(waiting), due(arrived + std::chrono::milliseconds(waiting.bytes / kBytesPerMs)) {}

ParseSchedule::Kind ParseSchedule::take(const Body& body) {
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

ParseSchedule::Waiting* ParseSchedule::give_back(Kind kind, const Body& body) {
  if (kind == Kind::any) {
    ++free_;
  } else {
    small_is_free_ = true;
  }
  const auto taken = taken_.find(body.client);
  if (--taken->second == 0) taken_.erase(taken);
  const auto place = next();
  if (place == waiting_.end()) return nullptr;
  Waiting* const waiting = *place;
  waiting->slot = take(waiting->body);
  waiting_.erase(place);
  return waiting;
}

/// Returns the body that gets a slot, while one is free.
std::list<ParseSchedule::Waiting*>::iterator ParseSchedule::next() {
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

/// A body whose thread waits.
struct ParseSlots::Waiting : ParseSchedule::Waiting {
  using ParseSchedule::Waiting::Waiting;

  std::condition_variable_any changed;
};

ParseSlots::Slot::Slot(ParseSlots& slots, Body body, const core::StopCondition& stop)
    : slots_(slots), body_(std::move(body)), kind_(slots.await(body_, stop)) {}

ParseSlots::Kind ParseSlots::await(const Body& body, const core::StopCondition& stop) {
  using Clock = core::StopCondition::Clock;
  std::unique_lock lock(mutex_);
  if (const Kind kind = schedule_.take(body); kind != Kind::none) return kind;
  Waiting waiting(body, Clock::now());
  schedule_.wait(waiting);
  const auto come = [&] { return waiting.slot != Kind::none; };
  // Some libraries overflow when they wait until the end of time.
  if (stop.deadline() == Clock::time_point::max()) {
    waiting.changed.wait(lock, stop.stop_token(), come);
  } else {
    waiting.changed.wait_until(lock, stop.stop_token(), stop.deadline(), come);
  }
  if (!come()) schedule_.stop_waiting(waiting);
  return waiting.slot;
}

void ParseSlots::Slot::release() {
  if (!has_slot()) return;
  slots_.give_back(std::exchange(kind_, Kind::none), body_);
}

void ParseSlots::give_back(Kind kind, const Body& body) {
  const std::lock_guard lock(mutex_);
  if (auto* const next = schedule_.give_back(kind, body)) static_cast<Waiting*>(next)->changed.notify_one();
}

}  // namespace fleetplan::server
