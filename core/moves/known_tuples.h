#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fleetplan::core {

/// Tuples of integers of one size. Each is kept once, numbered in the order in which they were added.
class KnownTuples {
 public:
  explicit KnownTuples(std::size_t size) : size_(size), table_(kFirstTable, kNone) {}

  std::size_t count() const { return count_; }
  /// The tuple that was added as the `number`-th one.
  std::vector<int>::const_iterator operator[](std::size_t number) const {
    return numbers_.begin() + static_cast<std::ptrdiff_t>(number * size_);
  }

  /// Adds the tuple unless it is known. Returns its number.
  std::uint32_t add(const std::vector<int>& tuple) {
    std::uint32_t& slot = table_[slot_of(tuple.begin())];
    if (slot != kNone) return slot;
    const auto number = static_cast<std::uint32_t>(count_);
    slot = number;
    numbers_.insert(numbers_.end(), tuple.begin(), tuple.end());
    ++count_;
    if (2 * count_ > table_.size()) grow();
    return number;
  }

 private:
  static constexpr std::size_t kFirstTable = 1024;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// FNV-1a by words, with a last mix of the bits.
  std::size_t hash_of(std::vector<int>::const_iterator tuple) const {
    std::uint64_t hash = 0xCBF29CE484222325;
    for (std::size_t k = 0; k < size_; ++k, ++tuple) {
      hash ^= static_cast<std::uint32_t>(*tuple);
      hash *= 0x100000001B3;
      hash ^= hash >> 29;
    }
    return hash;
  }

  /// Where the tuple is in the table, or a free slot if it is not there.
  std::size_t slot_of(std::vector<int>::const_iterator tuple) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash_of(tuple) & mask;
    // Bounded: half of the slots are free.
    while (table_[slot] != kNone &&
           !std::equal(tuple, tuple + static_cast<std::ptrdiff_t>(size_), (*this)[table_[slot]])) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  void grow() {
    table_.assign(2 * table_.size(), kNone);
    // Bounded: half of the slots stay free.
    for (std::uint32_t number = 0; number < count_; ++number) table_[slot_of((*this)[number])] = number;
  }

  const std::size_t size_;
  std::size_t count_ = 0;
  std::vector<int> numbers_;          // of all tuples, one after the other
  std::vector<std::uint32_t> table_;  // numbers by hash; its size is a power of two
};

}  // namespace fleetplan::core
