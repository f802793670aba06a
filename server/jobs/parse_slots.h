#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "core/runtime/stop_condition.h"

namespace fleetplan::server {

/// Which body is parsed next: the policy of ParseSlots, without threads and without a clock.
class ParseSchedule {
 public:
  using Time = core::StopCondition::Clock::time_point;

  /// Bodies up to this many bytes may use the additional slot.
  static constexpr std::size_t kSmall = std::size_t{64} * 1024;

  /// A body that is to be parsed.
  struct Body {
    std::string client;
    std::size_t bytes = 0;  // decoded, as far as that is known
  };
  enum class Kind { none, any, small };
  /// A body that waits.
  struct Waiting {
    Waiting(const Body& waiting, Time arrived);

    const Body& body;
    const Time due;          // the end of its parsing if it had been alone
    Kind slot = Kind::none;  // its slot, or none yet
  };

  explicit ParseSchedule(std::size_t slots) : free_(slots) {}

  /// Takes a free slot for a body and returns its kind; none if no slot is free.
  Kind take(const Body& body);
  /// Adds a body for which no slot is free to the queue. The wait ends when it gets a slot. The body must
  /// outlive its wait.
  void wait(Waiting& waiting) { waiting_.push_back(&waiting); }
  void stop_waiting(Waiting& waiting) { waiting_.remove(&waiting); }
  /// Takes a slot back from a body. Returns the waiting body that gets the slot, or null.
  Waiting* give_back(Kind kind, const Body& body);

 private:
  std::list<Waiting*>::iterator next();

  std::size_t free_;
  bool small_is_free_ = true;
  std::map<std::string, std::size_t> taken_;  // number of slots, by client
  std::list<Waiting*> waiting_;
};

/// Bounds how many bodies are parsed at the same time, because parsing needs many times the memory of the
/// body. Slots go round the clients: the next body is from the client that has the fewest slots.
///
/// Of this client's bodies, small ones come before large ones that arrived at the same time. But no body
/// waits for ever. The order is as if each body had been parsed alone since its arrival: the first to finish
/// is next. One more slot is for small bodies, so that they do not wait behind large bodies. Thread-safe.
class ParseSlots {
 public:
  using Body = ParseSchedule::Body;
  class Slot;

  explicit ParseSlots(std::size_t slots) : schedule_(slots) {}

 private:
  using Kind = ParseSchedule::Kind;
  struct Waiting;

  Kind await(const Body& body, const core::StopCondition& stop);
  void give_back(Kind kind, const Body& body);

  std::mutex mutex_;
  ParseSchedule schedule_;  // guarded by the mutex
};

/// Waits for a slot and holds it.
class ParseSlots::Slot {
 public:
  /// Waits for a slot, but no longer than until `stop` is met. Then has_slot() is false.
  Slot(ParseSlots& slots, Body body, const core::StopCondition& stop);
  ~Slot() { release(); }
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  bool has_slot() const { return kind_ != Kind::none; }
  void release();

 private:
  ParseSlots& slots_;
  const Body body_;
  Kind kind_;
};

}  // namespace fleetplan::server
