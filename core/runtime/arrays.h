#pragma once

// Arrays, a heap, and a sort of vectors that the standard library does not have.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace fleetplan::core {

/// A vector indexed by int, or by an enumeration over int, so that indices of different types cannot be mixed
/// up. Indices are 0 to size() - 1.
template <class T, class Index = int>
class IndexedVector {
 public:
  IndexedVector() = default;
  explicit IndexedVector(std::size_t size, const T& value = T()) : items_(size, value) {}

  T& operator[](Index index) { return items_[position(index)]; }
  const T& operator[](Index index) const { return items_[position(index)]; }
  T& back() { return items_.back(); }
  const T& back() const { return items_.back(); }

  std::size_t size() const { return items_.size(); }
  bool empty() const { return items_.empty(); }
  /// The index of the next element that is added.
  Index next_index() const { return static_cast<Index>(items_.size()); }

  /// Adds an element and returns its index.
  Index push_back(const T& item) {
    items_.push_back(item);
    return last_index();
  }
  Index push_back(T&& item) {
    items_.push_back(std::move(item));
    return last_index();
  }
  void resize(std::size_t size, const T& value = T()) { items_.resize(size, value); }
  void clear() { items_.clear(); }

  auto begin() { return items_.begin(); }
  auto end() { return items_.end(); }
  auto begin() const { return items_.begin(); }
  auto end() const { return items_.end(); }

 private:
  Index last_index() const { return static_cast<Index>(items_.size() - 1); }
  static std::size_t position(Index index) { return static_cast<std::size_t>(index); }

  std::vector<T> items_;
};

/// An array of default values for which few elements are used. It allocates memory only for pages with
/// accessed elements.
template <class T>
class PagedArray {
 public:
  explicit PagedArray(std::size_t size) : books_((size >> (2 * kBits)) + 1) {}

  T& operator[](std::size_t index) {
    auto& book = books_[index >> (2 * kBits)];
    if (!book) book = std::make_unique<Book>();
    auto& page = (*book)[(index >> kBits) & kMask];
    if (!page) {
      page = std::make_unique<Page>();
      ++pages_;
    }
    return (*page)[index & kMask];
  }

  /// Makes room for elements up to this size.
  void grow(std::size_t size) {
    if ((size >> (2 * kBits)) >= books_.size()) books_.resize((size >> (2 * kBits)) + 1);
  }

  /// Approximate memory in use.
  std::size_t bytes() const { return pages_ * sizeof(Page) + books_.size() * sizeof(books_[0]); }

 private:
  static constexpr std::size_t kBits = 6;
  static constexpr std::size_t kMask = (std::size_t{1} << kBits) - 1;
  using Page = std::array<T, std::size_t{1} << kBits>;
  using Book = std::array<std::unique_ptr<Page>, std::size_t{1} << kBits>;

  std::vector<std::unique_ptr<Book>> books_;
  std::size_t pages_ = 0;
};

/// A heap of items with keys, from which the least key is taken first (radix heap; Ahuja, Mehlhorn, Orlin and
/// Tarjan, JACM 1990). It is for searches whose keys hardly ever fall below the last key taken. It is faster
/// than a binary heap, because an item is moved only when the keys before it are gone.
///
/// Keys are at least 0. A key that is less than the last key taken counts as equal to it. The order of equal
/// keys is fixed, but arbitrary.
template <class Item>
class RadixHeap {
 public:
  bool empty() const { return size_ == 0; }

  void push(float key, const Item& item) {
    const auto bits = std::max(last_, std::bit_cast<std::uint32_t>(key));  // of floats >= 0, in their order
    bucket_of(bits).push_back({bits, item});
    ++size_;
  }

  /// Removes an item with the least key. The heap must not be empty.
  Item pop() {
    if (buckets_[0].empty()) refill();
    const Item item = buckets_[0].back().item;
    buckets_[0].pop_back();
    --size_;
    return item;
  }

 private:
  struct Entry {
    std::uint32_t bits;
    Item item;
  };

  /// By the highest bit in which a key differs from the last key taken.
  std::vector<Entry>& bucket_of(std::uint32_t bits) {
    return buckets_[static_cast<std::size_t>(std::bit_width(bits ^ last_))];
  }

  /// Takes the least key, and distributes the first bucket by it: each item moves to a lower bucket.
  void refill() {
    const auto bucket = std::find_if(buckets_.begin(), buckets_.end(), [](auto& b) { return !b.empty(); });
    last_ = std::min_element(bucket->begin(), bucket->end(), [](const Entry& a, const Entry& b) {
              return a.bits < b.bits;
            })->bits;
    for (const Entry& entry : *bucket) bucket_of(entry.bits).push_back(entry);
    bucket->clear();
  }

  std::array<std::vector<Entry>, 33> buckets_;
  std::uint32_t last_ = 0;  // the last key taken
  std::size_t size_ = 0;
};

/// Items that stoppable_sort() sorts at once.
inline constexpr std::size_t kSortChunk = 4096;

/// Sorts, because std::sort cannot be stopped: chunks of kSortChunk items, which are then merged. Calls
/// `met(items)` before it sorts or merges so many items, about a millisecond of work at first. Ends and
/// returns false when `met` returns true; the items are then in any order.
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
