#include "core/prioritized/search_memory.h"

#include <algorithm>
#include <utility>

namespace fleetplan::core {
namespace {

/// The most memory for the search spaces of all robots.
constexpr std::size_t kMaxBytes = std::size_t{384} << 20;

/// Whether so many bytes are too much to keep. Half of the job's memory is for the rest.
bool is_too_much(std::size_t bytes) {
  const MemoryAccount* account = MemoryScope::current();
  return bytes >= kMaxBytes || (account != nullptr && account->used() > account->limit() / 2);
}

}  // namespace

SearchSpaces::SearchSpaces(const Instance& instance) : instance_(instance), entries_(instance.size()) {}

SearchSpace* SearchSpaces::of(std::size_t robot, const StopCondition& stop) {
  if (!entries_[robot].space) {
    make_room();
    auto made = std::make_unique<SearchSpace>(instance_, robot, stop);
    if (!made->finished()) return nullptr;
    entries_[robot].space = std::move(made);
  }
  entries_[robot].last_use = ++calls_;
  return entries_[robot].space.get();
}

void SearchSpaces::discard_all() {
  for (Entry& entry : entries_) entry.space.reset();
}

/// Discards half of what is kept if it is too much.
void SearchSpaces::make_room() {
  std::size_t bytes = 0;
  std::vector<Entry*> kept;
  for (Entry& entry : entries_) {
    if (!entry.space) continue;
    bytes += entry.space->bytes();
    kept.push_back(&entry);
  }
  if (!is_too_much(bytes)) return;
  std::sort(kept.begin(), kept.end(),
            [](const Entry* a, const Entry* b) { return a->last_use < b->last_use; });
  const std::size_t enough = bytes / 2;
  for (Entry* entry : kept) {
    if (bytes <= enough) return;
    bytes -= entry->space->bytes();
    entry->space.reset();
  }
}

}  // namespace fleetplan::core
