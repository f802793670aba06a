#include "server/ops/metrics/metrics.h"

#include <algorithm>
#include <set>

#include "api/json/error.h"
#include "server/ops/metrics/metrics_text.h"
#include "server/ops/metrics/process_stats.h"
#include "server/ops/version.h"

namespace fleetplan::server {

namespace {

using Status = api::PlanOutcome::Status;

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

/// The statuses whose series exist from the start, so that none first appears when it goes up. A preflight
/// (204) may name any route. Answers to a GET with a broken or endless body are not usual.
std::set<int> usual_statuses(const Route& route) {
  std::set<int> usual{200, 204, 405, 421, 500};
  if (!route.traits.without_token) usual.insert(401);
  if (route.takes_body()) usual.insert({400, 403, 408, 413, 415, 422, 499, 503});
  if (route.traits.events) usual.insert(406);
  usual.insert(route.traits.statuses.begin(), route.traits.statuses.end());
  return usual;
}

/// The error's code if the exchange was refused. A probe that answers 503 while the server drains is not.
std::string_view rejection(const Exchange& exchange) {
  const bool is_probe = exchange.route != nullptr && exchange.route->traits.without_token;
  const bool unready = is_probe && exchange.problem == api::name_of(api::ErrorCode::draining);
  return unready ? std::string_view() : exchange.problem;
}

double as_double(std::uint64_t count) { return static_cast<double>(count); }

void write_process(MetricsText& text, std::chrono::system_clock::time_point started_at) {
  const ProcessStats stats = process_stats();
  const auto gauge = [&](std::string_view name, double value, std::string_view help) {
    text.metric(name, "gauge", help).sample(value);
  };
  text.metric("process_cpu_seconds_total", "counter", "User and system CPU time.").sample(stats.cpu_seconds);
  gauge("process_resident_memory_bytes", stats.resident_bytes, "Physical memory.");
  gauge("process_virtual_memory_bytes", stats.virtual_bytes, "Virtual memory.");
  gauge("process_open_fds", stats.open_fds, "Open file descriptors.");
  gauge("process_max_fds", stats.max_fds, "Maximum number of open file descriptors.");
  const std::chrono::duration<double> since_1970 = started_at.time_since_epoch();
  gauge("process_start_time_seconds", since_1970.count(), "Start of the process, seconds since 1970.");
}

void write_jobs(MetricsText& text, const WorkerLoad& jobs) {
  static constexpr std::array<std::string_view, kRefusals> kReasons{"queue_full", "share", "too_late"};
  text.metric("fleetplan_jobs_refused_total", "counter",
              "Jobs that found no place, or would get no turn in time.");
  for (std::size_t reason = 0; reason < kReasons.size(); ++reason) {
    text.sample(as_double(jobs.refused[reason]), {{"reason", kReasons[reason]}});
  }
  text.metric("fleetplan_improvements_paused", "gauge",
              "Anytime plans and simulations that wait while others compute.")
      .sample(as_double(jobs.paused));
  text.metric("fleetplan_improvements_ended_total", "counter",
              "Anytime plans returned before their time, as others waited.")
      .sample(as_double(jobs.ended_early));
}

}  // namespace

Metrics::Metrics(const RouteTable& routes) {
  // The path is unknown, or the head was refused before the path was looked up.
  requests_.emplace_back("unknown", std::set<int>{400, 401, 404, 408, 414, 421, 431});
  for (const Route& route : routes.routes()) requests_.emplace_back(route.path, usual_statuses(route));
  for (const api::ErrorRow& row : api::error_table()) rejected_[row.name];
}

Metrics::Requests& Metrics::requests_of(const Route* route) {
  if (route == nullptr) return requests_.front();
  const auto is_of_route = [&](const Requests& requests) { return requests.label == route->path; };
  const auto found = std::find_if(requests_.begin(), requests_.end(), is_of_route);
  return found == requests_.end() ? requests_.front() : *found;
}

void Metrics::count(const Exchange& exchange) {
  const int index = std::clamp(exchange.status - kFirstStatus, 0, kStatuses - 1);
  Requests& requests = requests_of(exchange.route);
  requests.by_status[static_cast<std::size_t>(index)].add();
  requests.seconds.observe(std::chrono::duration<double>(Exchange::Clock::now() - exchange.begun_at).count());
  if (exchange.queue_ms) queue_seconds_.observe(*exchange.queue_ms / 1000.0);
  if (exchange.queue_ms && !exchange.had_turn) queue_lost_seconds_.add(*exchange.queue_ms / 1000.0);
  if (exchange.abandoned) {
    if (exchange.route != nullptr && exchange.route->traits.plans) cancelled_.add();
    return;
  }
  const auto rejected = rejected_.find(rejection(exchange));
  if (rejected != rejected_.end()) rejected->second.add();
  if (exchange.late_s && *exchange.late_s > 0.0) late_seconds_.observe(*exchange.late_s);
  if (exchange.outcome) count_plan(*exchange.outcome);
}

void Metrics::count_plan(const api::PlanOutcome& outcome) {
  plans_[static_cast<std::size_t>(outcome.status)].add();
  if (outcome.status != Status::refused) {
    planned_robots_.add(outcome.planned);
    unplanned_robots_.add(outcome.unplanned);
    for (std::size_t reason = 0; reason < unplanned_by_reason_.size(); ++reason) {
      unplanned_by_reason_[reason].add(outcome.unplanned_by_reason[reason]);
    }
  }
  expansions_.add(static_cast<std::uint64_t>(outcome.expansions));
  if (outcome.plan_seconds) plan_seconds_.observe(*outcome.plan_seconds);
}

std::string Metrics::text(const Gauges& now) const {
  MetricsText text;
  const auto counter = [&](std::string_view name, const Counter& value, std::string_view help) {
    text.metric(name, "counter", help).sample(as_double(value.value()));
  };
  const auto gauge = [&](std::string_view name, std::size_t value, std::string_view help) {
    text.metric(name, "gauge", help).sample(as_double(value));
  };

  text.metric("fleetplan_build_info", "gauge", "The build that runs; always 1.")
      .sample(1.0, {{"version", kVersion}, {"compiler", kCompiler}});
  text.metric("fleetplan_requests_total", "counter", "Requests answered.");
  for (const Requests& requests : requests_) {
    for (int status = kFirstStatus; status < kFirstStatus + kStatuses; ++status) {
      const auto count = requests.by_status[static_cast<std::size_t>(status - kFirstStatus)].value();
      if (count == 0 && !requests.usual_statuses.contains(status)) continue;
      text.sample(as_double(count), {{"route", requests.label}, {"status", std::to_string(status)}});
    }
  }
  text.metric("fleetplan_request_seconds", "histogram",
              "From a request's first byte to the end of its answer.");
  for (const Requests& requests : requests_) text.histogram(requests.seconds, {{"route", requests.label}});
  text.metric("fleetplan_rejected_total", "counter",
              "Requests answered with a problem, except the 503 of /readyz.");
  for (const auto& [reason, count] : rejected_) {
    text.sample(as_double(count.value()), {{"reason", reason}});
  }
  text.metric("fleetplan_connections", "gauge", "Open connections.")
      .sample(as_double(now.connections), {{"port", "main"}})
      .sample(as_double(now.admin_connections), {{"port", "admin"}});
  gauge("fleetplan_workers", now.workers, "Plans and checks that can be computed at a time.");
  gauge("fleetplan_workers_busy", now.jobs.running, "Plans and checks being computed.");
  gauge("fleetplan_queue_depth", now.jobs.waiting, "Jobs that wait for a worker.");
  text.metric("fleetplan_queue_wait_seconds", "histogram", "How long jobs waited for a worker.")
      .histogram(queue_seconds_);
  text.metric("fleetplan_queue_lost_seconds_total", "counter", "Waiting of jobs that got no turn.")
      .sample(queue_lost_seconds_.value());
  write_jobs(text, now.jobs);
  text.metric("fleetplan_late_seconds", "histogram",
              "How long after the end of their budget answers were made, of those that were late.")
      .histogram(late_seconds_);
  text.metric("fleetplan_plans_total", "counter", "Plans returned.");
  for (const Status status : {Status::solved, Status::partial, Status::none}) {
    const double count = as_double(plans_[static_cast<std::size_t>(status)].value());
    text.sample(count, {{"outcome", api::name_of(status)}});
  }
  counter("fleetplan_plans_refused_total", plans_[static_cast<std::size_t>(Status::refused)],
          "Plans that the checker rejected; each is a bug.");
  counter("fleetplan_plans_cancelled_total", cancelled_, "Plans whose client left before the answer.");
  text.metric("fleetplan_plan_seconds", "histogram", "Time that planning took, of plans that were started.")
      .histogram(plan_seconds_);
  text.metric("fleetplan_robots_total", "counter", "Robots of the plans.");
  text.sample(as_double(planned_robots_.value()), {{"outcome", "planned"}});
  text.sample(as_double(unplanned_robots_.value()), {{"outcome", "unplanned"}});
  text.metric("fleetplan_unplanned_robots_total", "counter", "Unplanned robots of the plans.");
  for (std::size_t reason = 0; reason < unplanned_by_reason_.size(); ++reason) {
    text.sample(as_double(unplanned_by_reason_[reason].value()),
                {{"reason", api::name_of(static_cast<core::Unplanned::Reason>(reason))}});
  }
  counter("fleetplan_expansions_total", expansions_, "Search labels expanded.");
  text.metric("fleetplan_map_cache_hits_total", "counter",
              "Maps of requests that were kept from earlier ones.")
      .sample(as_double(now.maps.hits));
  text.metric("fleetplan_map_cache_misses_total", "counter", "Maps of requests that had to be made.")
      .sample(as_double(now.maps.misses));
  gauge("fleetplan_map_cache_maps", now.maps.maps, "Maps that are kept or in use.");
  gauge("fleetplan_map_cache_bytes", now.maps.bytes, "Memory of the maps that are kept or in use.");
  gauge("fleetplan_unsent_bytes", now.unsent.bytes, "Memory of answers that clients have not accepted yet.");
  text.metric("fleetplan_unsent_dropped_total", "counter",
              "Answers dropped as their clients did not read them and others needed the memory.")
      .sample(as_double(now.unsent.dropped));
  text.metric("fleetplan_log_lines_dropped_total", "counter", "Log lines dropped: stderr was not read.")
      .sample(as_double(now.log_dropped));
  write_process(text, started_at_);
  return text.take();
}

}  // namespace fleetplan::server
