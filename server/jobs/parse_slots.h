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
  struct Waiting;
  struct Free {
    explicit Free(std::size_t slots) : any(slots) {}
    std::size_t any;
    bool small = true;
  };

  std::mutex mutex_;
  Free free_;
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
  friend class ParseSlots;
  enum class Kind { none, any, small };

  /// A free slot for such a body, which is taken.
  static Kind take(Free& free, std::size_t bytes);

  ParseSlots& slots_;
  Kind kind_ = Kind::none;
};

}  // namespace fleetplan::server
