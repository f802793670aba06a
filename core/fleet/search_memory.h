#pragma once

// What searches keep for later ones.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "core/compile/instance.h"
#include "core/reservation/reservation_table.h"
#include "core/runtime/memory_account.h"
#include "core/runtime/stop_condition.h"
#include "core/sipp/aa_sipp.h"
#include "core/sipp/search_space.h"

namespace fleetplan::core {

/// The search spaces of the robots, kept from search to search as far as there is memory. Others are
/// discarded, and computed again when needed. First, the spaces that are expected to be used last are
/// discarded; then the least recently used ones.
class SearchSpaces {
 public:
  /// `instance` outlives this object.
  explicit SearchSpaces(const Instance& instance);

  /// Returns the search space of a robot, valid until the next call for another robot. Null if `stop` is met
  /// before it is made.
  SearchSpace* of(std::size_t robot, const StopCondition& stop);
  /// Tells when the space of a robot will be used next: after so many uses of other spaces. Holds until then.
  void expect_use(std::size_t robot, std::int64_t uses) { entries_[robot].last_use = -uses; }
  void discard_all();
  /// How many spaces were discarded so far for lack of memory.
  std::int64_t discarded() const { return discarded_; }

 private:
  struct Entry {
    std::unique_ptr<SearchSpace> space;
    std::int64_t last_use = 0;  // the number of the last call for it; < 0: see expect_use()
  };

  void make_room();

  const Instance& instance_;
  std::vector<Entry> entries_;  // by robot
  std::int64_t calls_ = 0;
  std::int64_t discarded_ = 0;
};

/// What searches keep for later searches: the search spaces of robots, and the arrays of a search. It is
/// freed when the job's memory is short (see MemoryAccount).
class SearchMemory {
 public:
  /// The arguments outlive this object.
  SearchMemory(const Instance& instance, const ReservationTable& table) : spaces_(instance), search_(table) {}

  /// Returns the search space of a robot, valid until the next call for another robot. Null if `stop` is met
  /// before it is made.
  SearchSpace* space_of(std::size_t robot, const StopCondition& stop) { return spaces_.of(robot, stop); }
  /// Tells when the search space of a robot will be used next: after so many uses of other spaces. This
  /// decides which spaces are discarded first.
  void expect_use(std::size_t robot, std::int64_t uses) { spaces_.expect_use(robot, uses); }
  static constexpr std::int64_t kHardlyEver = std::numeric_limits<std::int64_t>::max();
  /// How many search spaces were discarded so far for lack of memory.
  std::int64_t discarded() const { return spaces_.discarded(); }
  /// The search among the reservations of the table.
  AaSipp& search() { return search_; }

  /// Returns what `compute` returns, or `otherwise` if the memory for it is not granted.
  template <class Result, class Compute>
  Result within_memory(Result otherwise, const Compute& compute) {
    bool is_spent = false;
    try {
      otherwise = compute();
    } catch (const std::bad_alloc&) {
      is_spent = true;
    }
    if (is_spent || is_short_of_memory()) release();
    return otherwise;
  }

  /// Frees what is kept, if memory is short.
  void relieve() {
    if (is_short_of_memory()) release();
  }

 private:
  void release() {
    search_.release_memory();
    spaces_.discard_all();
  }

  SearchSpaces spaces_;
  AaSipp search_;
};

}  // namespace fleetplan::core
