#pragma once

// Numbers that many threads change and one reads from time to time. Each is consistent by itself; together
// they may be from slightly different moments, as Prometheus expects.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace fleetplan::server {

/// Only grows.
class Counter {
 public:
  void add(std::uint64_t amount = 1) { value_.fetch_add(amount, std::memory_order_relaxed); }
  std::uint64_t value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

/// A sum that only grows.
class Sum {
 public:
  void add(double amount) { value_.fetch_add(amount, std::memory_order_relaxed); }
  double value() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<double> value_{0.0};
};

/// Durations by size.
class Histogram {
 public:
  /// Upper bounds of the buckets, seconds, inclusive; whatever is longer is counted beyond the last.
  static constexpr std::array<double, 16> kBounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,  0.25,
                                                  0.5,   1.0,    2.5,   5.0,  10.0,  30.0, 60.0, 120.0};

  void observe(double seconds) {
    std::size_t bucket = 0;
    while (bucket < kBounds.size() && seconds > kBounds[bucket]) ++bucket;
    counts_[bucket].add();
    sum_.add(seconds);
  }

  /// In bucket `index` alone; kBounds.size() is the one beyond the last bound.
  std::uint64_t count(std::size_t index) const { return counts_[index].value(); }
  double sum() const { return sum_.value(); }

 private:
  std::array<Counter, kBounds.size() + 1> counts_;
  Sum sum_;
};

}  // namespace fleetplan::server
