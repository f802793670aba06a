#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace fleetplan::core {

/// The memory of one job in bytes: what its threads have allocated with `new`, minus what they have freed. It
/// counts in programs that link core/runtime/allocation_hook.cpp; elsewhere it stays at 0. Thread-safe.
///
/// Three quarters of the limit are for computing. Beyond that, the job is *short of memory*: StopCondition is
/// met, and searches end as when the time is up. The last quarter is for what remains to be done, such as a
/// partial plan and the answer. Beyond the limit, `new` throws std::bad_alloc.
///
/// It is not exact, for these reasons:
///
/// - A thread reports its allocations in batches of kBatch.
/// - Memory that a thread without the account frees stays counted.
/// - Memory that such a thread allocates and a thread of the job frees is subtracted.
class MemoryAccount {
 public:
  /// A thread reports when it has allocated or freed so many bytes.
  static constexpr std::int64_t kBatch = 32 * 1024;

  explicit MemoryAccount(std::size_t limit)
      : limit_(static_cast<std::int64_t>(limit)), enough_(limit_ - limit_ / 4) {}
  MemoryAccount(const MemoryAccount&) = delete;
  MemoryAccount& operator=(const MemoryAccount&) = delete;

  std::int64_t limit() const { return limit_; }
  std::int64_t used() const { return used_.load(std::memory_order_relaxed); }
  /// The largest value of used() so far.
  std::int64_t peak() const { return peak_.load(std::memory_order_relaxed); }

  bool is_short() const { return used() > enough_; }
  /// How often the job became short of memory, or was refused memory.
  std::int64_t shortages() const { return shortages_.load(std::memory_order_relaxed); }

  /// Counts bytes that were allocated; a negative number for bytes that were freed.
  void count(std::int64_t bytes);
  /// Counts bytes unless that would exceed the limit. Then counts nothing and returns false.
  bool reserve(std::int64_t bytes);

  /// Destroys the object together with the account. Freeing the memory of a large plan takes longer than
  /// checking it, so it may wait until the answer is sent. Only one thread may call this at a time.
  void keep(std::shared_ptr<const void> object) { kept_.push_back(std::move(object)); }

 private:
  void added(std::int64_t used, std::int64_t bytes);

  const std::int64_t limit_;
  const std::int64_t enough_;
  std::atomic<std::int64_t> used_{0};
  std::atomic<std::int64_t> peak_{0};
  std::atomic<std::int64_t> shortages_{0};
  std::vector<std::shared_ptr<const void>> kept_;
};

/// What this thread has allocated since its last report, and the account that it reports to, if any.
struct MemoryTally {
  MemoryAccount* account = nullptr;
  std::int64_t pending = 0;  // bytes

  /// Counts an allocation. Returns false, and counts nothing, if it exceeds the account's limit.
  bool charge(std::size_t bytes) {
    pending += static_cast<std::int64_t>(bytes);
    return pending < MemoryAccount::kBatch || report_or_undo(bytes);
  }
  void credit(std::size_t bytes) {
    pending -= static_cast<std::int64_t>(bytes);
    if (pending <= -MemoryAccount::kBatch) report();
  }
  void report();

 private:
  bool report_or_undo(std::size_t bytes);
};

/// The tally of this thread. `operator new` and `operator delete` have no other way to know for which job
/// they work.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): changed by MemoryScope only
extern constinit thread_local MemoryTally memory_tally;

/// During its lifetime, this thread's allocations count on an account, or on none. Scopes nest.
class MemoryScope {
 public:
  /// Begins the scope. The account must outlive it. Null: allocations are not counted during the scope.
  explicit MemoryScope(MemoryAccount* account) : before_(memory_tally) { memory_tally = {account}; }
  ~MemoryScope() {
    memory_tally.report();
    memory_tally = before_;
  }
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

  /// The account of this thread; null if there is none.
  static MemoryAccount* current() { return memory_tally.account; }

 private:
  const MemoryTally before_;
};

/// Whether the job of this thread is short of memory.
inline bool is_short_of_memory() {
  const MemoryAccount* account = MemoryScope::current();
  return account != nullptr && account->is_short();
}

/// Keeps the object with the account of this thread. Destroys it at once if there is no account or its memory
/// is needed.
inline void keep_for_later(std::shared_ptr<const void> object) {
  MemoryAccount* account = MemoryScope::current();
  if (account != nullptr && !account->is_short()) account->keep(std::move(object));
}

/// The number of shortages of this thread's job so far.
inline std::int64_t memory_shortages() {
  const MemoryAccount* account = MemoryScope::current();
  return account != nullptr ? account->shortages() : 0;
}

}  // namespace fleetplan::core
