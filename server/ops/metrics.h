#pragma once

// Kinds of metrics, and their text. Many threads change the numbers, and one thread reads them from time to
// time. Each number is consistent by itself. Together, they may be from slightly different moments, as
// Prometheus expects.

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/map/static_map.h"
#include "server/http/answer/unsent_answers.h"
#include "server/http/exchange.h"
#include "server/http/route_table.h"

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
  /// Upper bounds of the buckets, seconds, inclusive. Longer durations are counted beyond the last bound.
  static constexpr std::array<double, 16> kBounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,  0.25,
                                                  0.5,   1.0,    2.5,   5.0,  10.0,  30.0, 60.0, 120.0};

  void observe(double seconds) {
    std::size_t bucket = 0;
    while (bucket < kBounds.size() && seconds > kBounds[bucket]) ++bucket;
    counts_[bucket].add();
    sum_.add(seconds);
  }

  /// The number of durations in bucket `index` alone. kBounds.size() is the bucket beyond the last bound.
  std::uint64_t count(std::size_t index) const { return counts_[index].value(); }
  double sum() const { return sum_.value(); }

 private:
  std::array<Counter, kBounds.size() + 1> counts_;
  Sum sum_;
};

inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// Writes metrics in the text format of Prometheus, version 0.0.4. It is written here because Debian's
/// prometheus-cpp would bring another web server and curl's development files for these few lines.
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

/// Why a job is refused:
///
/// - queue_full: there is no place.
/// - share: there is no place beyond its client's share.
/// - too_late: its turn would come too late, or did not come in time.
enum class Refusal { queue_full, share, too_late };
inline constexpr std::size_t kRefusals = 3;

/// The load of the workers, and counts of jobs since the start.
struct WorkerLoad {
  std::size_t waiting = 0;
  std::size_t running = 0;
  std::size_t paused = 0;
  std::array<std::uint64_t, kRefusals> refused{};  // by reason
  std::uint64_t ended_early = 0;                   // improvements that ended because others got their turn
};

/// The current load.
struct Gauges {
  std::size_t connections = 0;        // served connections
  std::size_t admin_connections = 0;  // served connections of the admin port
  std::size_t workers = 0;            // the most jobs that compute
  WorkerLoad jobs;
  std::uint64_t log_dropped = 0;  // lines dropped since the start
  core::MapCache::Stats maps;
  UnsentAnswers::Stats unsent;
};

/// Counts requests and plans since the start. Thread-safe; counting takes no lock.
class Metrics {
 public:
  /// Counts by `routes`, the routes of the main port. They include the admin port's routes.
  explicit Metrics(const RouteTable& routes);

  /// Counts an exchange that is over.
  void count(const Exchange& exchange);

  /// Returns the answer to GET /metrics, see MetricsText. All series exist from the start, except for
  /// statuses that are unusual on their route.
  std::string text(const Gauges& load) const;

 private:
  static constexpr int kFirstStatus = 100;
  static constexpr int kStatuses = 500;  // 100 to 599
  using ByStatus = std::array<Counter, kStatuses>;

  /// The requests of a route, labelled with its path.
  struct Requests {
    Requests(std::string path, std::set<int> usual)
        : label(std::move(path)), usual_statuses(std::move(usual)) {}

    const std::string label;
    const std::set<int> usual_statuses;
    ByStatus by_status = {};
    Histogram seconds = {};
  };

  struct Moment;
  struct Row;

  static std::span<const Row> table();

  void write_requests(MetricsText& text) const;
  Requests& requests_of(const Route* route);
  void count_plan(const api::PlanOutcome& outcome);

  const std::chrono::system_clock::time_point started_at_ = std::chrono::system_clock::now();
  std::deque<Requests> requests_;                 // by route; requests of unknown paths come first
  std::map<std::string_view, Counter> rejected_;  // by the problem's code
  Histogram queue_seconds_;
  Sum queue_lost_seconds_;
  Histogram late_seconds_;
  Histogram plan_seconds_;
  std::array<Counter, 4> plans_;  // by PlanOutcome::Status
  Counter cancelled_;
  Counter planned_robots_;
  Counter unplanned_robots_;
  std::array<Counter, core::kUnplannedReasons> unplanned_by_reason_;
  Counter expansions_;
};

}  // namespace fleetplan::server
