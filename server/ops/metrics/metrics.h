#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/map/static_map.h"
#include "server/http/answer/unsent_answers.h"
#include "server/http/exchange.h"
#include "server/http/route_table.h"
#include "server/ops/metrics/metrics_text.h"
#include "server/ops/metrics/worker_load.h"

namespace fleetplan::server {

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
  /// Counts by `routes`, those of the main port; the admin port's are among them.
  explicit Metrics(const RouteTable& routes);

  /// Counts an exchange that is over.
  void count(const Exchange& exchange);

  /// Returns the answer to GET /metrics, see MetricsText. All series exist from the start, except those of
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
