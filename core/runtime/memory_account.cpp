#include "core/runtime/memory_account.h"

#include "core/runtime/memory_lack.h"

namespace fleetplan::core {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): see the header
constinit thread_local MemoryTally memory_tally;

void MemoryAccount::count(std::int64_t bytes) {
  added(used_.fetch_add(bytes, std::memory_order_relaxed) + bytes, bytes);
}

bool MemoryAccount::reserve(std::int64_t bytes) {
  const std::int64_t used = used_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  if (used > limit_) {
    used_.fetch_sub(bytes, std::memory_order_relaxed);
    shortages_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  added(used, bytes);
  return true;
}

/// Updates what depends on the bytes in use, which have grown by `bytes` to `used`.
void MemoryAccount::added(std::int64_t used, std::int64_t bytes) {
  if (used > enough_ && used - bytes <= enough_) shortages_.fetch_add(1, std::memory_order_relaxed);
  std::int64_t peak = peak_.load(std::memory_order_relaxed);
  while (used > peak && !peak_.compare_exchange_weak(peak, used, std::memory_order_relaxed)) {
  }
}

bool MemoryTally::report_or_undo(std::size_t bytes) {
  if (account == nullptr || account->reserve(pending)) {
    pending = 0;
    return true;
  }
  pending -= static_cast<std::int64_t>(bytes);
  return false;
}

namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): memory is that of the process
constinit std::atomic<std::int64_t> lacks{0};

}  // namespace

std::int64_t memory_lacks() { return lacks.load(std::memory_order_relaxed); }

void note_memory_lack(std::size_t bytes) {
  MemoryAccount* account = memory_tally.account;
  const std::int64_t wanted = memory_tally.pending + static_cast<std::int64_t>(bytes);
  if (account != nullptr && !account->reserve(wanted)) return;  // it has counted a shortage
  if (account != nullptr) account->count(-wanted);
  lacks.fetch_add(1, std::memory_order_relaxed);
}

void MemoryTally::report() {
  if (account != nullptr) account->count(pending);
  pending = 0;
}

}  // namespace fleetplan::core
