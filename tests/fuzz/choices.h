#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace fleetplan::fuzz {

/// The bytes of an input as decisions of a generator. They are zeros after the last one.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool any_left() const { return at_ < bytes_.size(); }
  std::uint8_t byte() { return any_left() ? bytes_[at_++] : std::uint8_t{0}; }
  /// One of 0 to count - 1; count is at most 256.
  int below(int count) { return byte() % count; }
  bool one_in(int count) { return below(count) == count - 1; }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (int k = 0; k < 4; ++k) value = value << 8U | byte();
    return value;
  }
  std::string bytes(int count) {
    std::string text;
    for (int k = 0; k < count; ++k) text += static_cast<char>(byte());
    return text;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace fleetplan::fuzz
