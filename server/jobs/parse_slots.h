#pragma once

#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>

#include "core/runtime/stop_condition.h"

namespace fleetplan::server {

/// Bounds how many bodies are parsed at the same time, as parsing needs many times the memory of the body.
/// The smallest body is next. One more slot is for small bodies, so that these do not wait behind large ones.
/// Thread-safe.
class ParseSlots {
 public:
  /// Bodies up to this many bytes may use the additional slot.
  static constexpr std::size_t kSmall = std::size_t{64} * 1024;

  explicit ParseSlots(std::size_t slots) : free_(slots) {}

  class Slot;

 private:
  enum class Kind { none, any, small };
  struct Waiting;

  Kind await(std::size_t bytes, const core::StopCondition& stop);
  Kind take(std::size_t bytes);
  void give_back(Kind kind);

  std::mutex mutex_;
  std::size_t free_;
  bool small_is_free_ = true;
  std::list<Waiting*> waiting_;
};

/// Waits for a slot and holds it.
class ParseSlots::Slot {
 public:
  /// For a body of so many bytes. Waits until `stop` is met at most; then has_slot() is false.
  Slot(ParseSlots& slots, std::size_t bytes, const core::StopCondition& stop);
  ~Slot() { release(); }
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  bool has_slot() const { return kind_ != Kind::none; }
  void release();

 private:
  ParseSlots& slots_;
  Kind kind_;
};

}  // namespace fleetplan::server
