#include "core/fleet/search_memory.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

/// The most memory for the search spaces of all robots.
constexpr std::size_t kMaxBytes = std::size_t{384} << 20;

/// Whether the job will soon be short of memory (MemoryAccount), which ends searches.
bool is_nearly_short() {
  const MemoryAccount* account = MemoryScope::current();
  return account != nullptr && account->used() > account->limit() / 16 * 11;
}

}  // namespace

SearchSpaces::SearchSpaces(const Instance& instance) : instance_(instance), entries_(instance.size()) {}

SearchSpace* SearchSpaces::of(std::size_t robot, const StopCondition& stop) {
  Entry& entry = entries_[robot];
  entry.last_use = ++calls_;
  if (!entry.space || is_nearly_short()) make_room();
  if (!entry.space) {
    auto made = std::make_unique<SearchSpace>(instance_, robot, stop);
    if (!made->finished()) return nullptr;
    entry.space = std::move(made);
  }
  return entry.space.get();
}

void SearchSpaces::discard_all() {
  for (Entry& entry : entries_) entry.space.reset();
  ++discarded_;
}

/// Discards an eighth of what is kept if it is too much, but not the space that was used last.
void SearchSpaces::make_room() {
  std::size_t bytes = 0;
  std::vector<Entry*> kept;
  for (Entry& entry : entries_) {
    if (!entry.space) continue;
    bytes += entry.space->bytes();
    kept.push_back(&entry);
  }
  if (bytes < kMaxBytes && !is_nearly_short()) return;
  std::sort(kept.begin(), kept.end(),
            [](const Entry* a, const Entry* b) { return a->last_use < b->last_use; });
  const std::size_t enough = bytes - bytes / 8;
  for (Entry* entry : kept) {
    if (bytes <= enough || entry->last_use == calls_) return;
    bytes -= entry->space->bytes();
    entry->space.reset();
    ++discarded_;
  }
}

}  // namespace fleetplan::core
