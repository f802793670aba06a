#include "server/ops/metrics.h"

#include <algorithm>
#include <initializer_list>

#include "api/response/error.h"
#include "server/ops/metrics_text.h"
#include "server/ops/process_stats.h"
#include "server/ops/version.h"

namespace fleetplan::server {

namespace {

using Status = api::PlanOutcome::Status;

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

/// What is usually answered there, so that a series does not first appear when it goes up. What is found
/// before the route is known counts as unknown; a preflight (204) may ask for any route. What only a GET with
/// a broken or endless body gets is not usual.
std::initializer_list<int> usual_statuses(Endpoint endpoint) {
  static constexpr auto kUnknown = {400, 401, 404, 408, 414, 431};
  static constexpr auto kPlan = {200, 204, 400, 401, 405, 406, 408, 413, 415, 422, 499, 500, 503};
  static constexpr auto kValidate = {200, 204, 400, 401, 405, 408, 413, 415, 422, 499, 500, 503};
  static constexpr auto kHealth = {200, 204, 405, 500};
  static constexpr auto kReadiness = {200, 204, 405, 500, 503};
  static constexpr auto kPage = {200, 204, 304, 401, 404, 405, 500};
  static constexpr auto kExample = {200, 204, 401, 404, 405, 500};
  static constexpr auto kOther = {200, 204, 401, 405, 500};
  switch (endpoint) {
    case Endpoint::unknown:
      return kUnknown;
    case Endpoint::plan:
      return kPlan;
    case Endpoint::validate:
      return kValidate;
    case Endpoint::healthz:
      return kHealth;
    case Endpoint::readyz:
      return kReadiness;
    case Endpoint::page:
      return kPage;
    case Endpoint::example:
      return kExample;
    default:
      return kOther;
  }
}

/// The error's code if the exchange was refused. That /readyz says 503 is its answer.
std::string_view rejection(const Exchange& exchange) {
  const bool unready = exchange.route.endpoint == Endpoint::readyz &&
                       exchange.problem == api::name_of(api::ErrorCode::draining);
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
  gauge("process_max_fds", stats.max_fds, "Most file descriptors that may be open.");
  const std::chrono::duration<double> since_1970 = started_at.time_since_epoch();
  gauge("process_start_time_seconds", since_1970.count(), "Start of the process, seconds since 1970.");
}

}  // namespace

Metrics::Metrics() {
  for (const api::ErrorCode code : api::error_codes()) rejected_[api::name_of(code)];
}

void Metrics::count(const Exchange& exchange) {
  const int index = std::clamp(exchange.status - kFirstStatus, 0, kStatuses - 1);
  requests_[static_cast<std::size_t>(exchange.route.endpoint)][static_cast<std::size_t>(index)].add();
  if (exchange.queue_ms) queue_seconds_.observe(*exchange.queue_ms / 1000.0);
  if (exchange.abandoned) {
    if (exchange.route.endpoint == Endpoint::plan) cancelled_.add();
    return;
  }
  const auto rejected = rejected_.find(rejection(exchange));
  if (rejected != rejected_.end()) rejected->second.add();
  if (exchange.outcome) count_plan(*exchange.outcome);
}

void Metrics::count_plan(const api::PlanOutcome& outcome) {
  plans_[static_cast<std::size_t>(outcome.status)].add();
  if (outcome.status != Status::refused) {
    planned_robots_.add(outcome.planned);
    unplanned_robots_.add(outcome.unplanned);
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
  for (const Endpoint endpoint : kEndpoints) {
    const auto usual = usual_statuses(endpoint);
    for (int status = kFirstStatus; status < kFirstStatus + kStatuses; ++status) {
      const auto& at = requests_[static_cast<std::size_t>(endpoint)];
      const auto count = at[static_cast<std::size_t>(status - kFirstStatus)].value();
      if (count == 0 && std::find(usual.begin(), usual.end(), status) == usual.end()) continue;
      text.sample(as_double(count), {{"route", name_of(endpoint)}, {"status", std::to_string(status)}});
    }
  }
  text.metric("fleetplan_rejected_total", "counter",
              "Requests answered with a problem, but for the 503 of /readyz.");
  for (const auto& [reason, count] : rejected_) {
    text.sample(as_double(count.value()), {{"reason", reason}});
  }
  text.metric("fleetplan_connections", "gauge", "Connections that are served.")
      .sample(as_double(now.connections), {{"port", "main"}})
      .sample(as_double(now.admin_connections), {{"port", "admin"}});
  gauge("fleetplan_workers", now.workers, "Plans and checks computed at a time at most.");
  gauge("fleetplan_workers_busy", now.busy, "Plans and checks being computed.");
  gauge("fleetplan_queue_depth", now.queued, "Jobs that wait for a worker.");
  text.metric("fleetplan_queue_wait_seconds", "histogram", "How long jobs waited for a worker.")
      .histogram(queue_seconds_);
  text.metric("fleetplan_plans_total", "counter", "Plans returned.");
  for (const Status status : {Status::solved, Status::partial, Status::none}) {
    const double count = as_double(plans_[static_cast<std::size_t>(status)].value());
    text.sample(count, {{"outcome", api::name_of(status)}});
  }
  counter("fleetplan_plans_refused_total", plans_[static_cast<std::size_t>(Status::refused)],
          "Plans that the checker refused; each is a bug.");
  counter("fleetplan_plans_cancelled_total", cancelled_, "Plans whose client left before the answer.");
  text.metric("fleetplan_plan_seconds", "histogram", "How long planning took, where there was time for it.")
      .histogram(plan_seconds_);
  text.metric("fleetplan_robots_total", "counter", "Robots of the plans.");
  text.sample(as_double(planned_robots_.value()), {{"outcome", "planned"}});
  text.sample(as_double(unplanned_robots_.value()), {{"outcome", "unplanned"}});
  counter("fleetplan_expansions_total", expansions_, "Search labels expanded.");
  write_process(text, started_at_);
  return text.take();
}

}  // namespace fleetplan::server
