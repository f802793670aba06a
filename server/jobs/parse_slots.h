#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <string>

#include "core/runtime/stop_condition.h"

namespace fleetplan::server {

/// Bounds how many bodies are parsed at the same time, as parsing needs many times the memory of the body.
/// Slots go round the clients: next is a body of the client that has the fewest. Of those, small bodies come
/// before large ones that arrived at the same time, but no body waits for ever: next is the one that would
/// have been parsed first if each had been parsed alone since it arrived. One more slot is for small bodies,
/// so that these do not wait behind large ones. Thread-safe.
class ParseSlots {
 public:
  /// Bodies up to this many bytes may use the additional slot.
  static constexpr std::size_t kSmall = std::size_t{64} * 1024;

  explicit ParseSlots(std::size_t slots) : free_(slots) {}

  /// A body that is to be parsed.
  struct Body {
    std::string client;
    std::size_t bytes = 0;  // decoded, as far as that is known
  };
  class Slot;

  /// The number of bodies that wait for a slot.
  std::size_t waiting() const;

 private:
  using Clock = core::StopCondition::Clock;
  enum class Kind { none, any, small };
  struct Waiting;

  Kind await(const Body& body, const core::StopCondition& stop);
  Kind take(const Body& body);
  void give_back(Kind kind, const Body& body);
  std::list<Waiting*>::iterator next();

  mutable std::mutex mutex_;
  std::size_t free_;
  bool small_is_free_ = true;
  std::map<std::string, std::size_t> taken_;  // number of slots, by client
  std::list<Waiting*> waiting_;
};

/// Waits for a slot and holds it.
class ParseSlots::Slot {
 public:
  /// Waits for a slot, but no longer than until `stop` is met; then has_slot() is false.
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
