#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fleetplan::core {

/// Sorts, as std::sort cannot be stopped: chunks of kSortChunk items, which are then merged. Calls
/// `met(items)` before it sorts or merges so many, about a millisecond of work at first; ends when that
/// returns true. Returns false then, and the items are in any order.
inline constexpr std::size_t kSortChunk = 4096;

template <class T, class Less, class Met>
bool stoppable_sort(std::vector<T>& items, const Less& less, const Met& met) {
  const auto at = [&](std::size_t index) {
    return items.begin() + static_cast<std::ptrdiff_t>(std::min(index, items.size()));
  };
  for (std::size_t begin = 0; begin < items.size(); begin += kSortChunk) {
    if (met(kSortChunk)) return false;
    std::sort(at(begin), at(begin + kSortChunk), less);
  }
  // Bounded: `met` is asked before each merge.
  for (std::size_t width = kSortChunk; width < items.size(); width *= 2) {
    for (std::size_t begin = 0; begin < items.size(); begin += 2 * width) {
      if (met(2 * width)) return false;
      std::inplace_merge(at(begin), at(begin + width), at(begin + 2 * width), less);
    }
  }
  return true;
}

}  // namespace fleetplan::core
