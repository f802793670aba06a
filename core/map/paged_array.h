#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace fleetplan::core {

/// An array of default values that allocates memory only for pages with accessed elements. For large arrays
/// of which few elements are used.
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

}  // namespace fleetplan::core
