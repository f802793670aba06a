#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace fleetplan::core {

/// Random choices that are the same on every machine. The C++ standard fixes the engine. The distributions
/// are implemented here, because the standard ones differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Draws a number from [0, count), count >= 1, uniformly; the bias is below count / 2^64.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  /// Draws a seed for another Random.
  std::uint64_t seed() { return engine_(); }
  /// Draws a number from [0, 1), uniformly.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace fleetplan::core
