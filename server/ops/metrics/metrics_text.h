#pragma once

// Kinds of metrics, and their text. Many threads change the numbers, and one reads them from time to time.
// Each is consistent by itself; together they may be from slightly different moments, as Prometheus expects.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fleetplan::server {

/// A number that only grows.
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

/// Durations, counted by size.
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

  /// The number of durations in bucket `index` alone; kBounds.size() is the bucket beyond the last bound.
  std::uint64_t count(std::size_t index) const { return counts_[index].value(); }
  double sum() const { return sum_.value(); }

 private:
  std::array<Counter, kBounds.size() + 1> counts_;
  Sum sum_;
};

inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Writes metrics in the text format of Prometheus, version 0.0.4. Written here because Debian's
/// prometheus-cpp would bring another web server and curl's development files along for these few lines.
class MetricsText {
 public:
  using Labels = std::vector<std::pair<std::string_view, std::string_view>>;

  /// Begins a metric; its samples follow. `type`: counter, gauge or histogram.
  MetricsText& metric(std::string_view name, std::string_view type, std::string_view help);

  MetricsText& sample(double value, const Labels& labels = {});

  /// Writes all samples of a histogram.
  MetricsText& histogram(const Histogram& values, const Labels& labels = {});

  std::string take() { return std::move(text_); }

 private:
  void line(std::string_view suffix, double value, const Labels& labels);

  std::string text_;
  std::string name_;
};

}  // namespace fleetplan::server
