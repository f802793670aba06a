#include "server/ops/metrics.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "api/json/errors.h"
#include "server/ops/process.h"

namespace fleetplan::server {

namespace {

/// Returns the shortest text that reads back as the same number.
std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string escaped(std::string_view label) {
  std::string text;
  for (const char c : label) {
    if (c == '\\' || c == '"') text += '\\';
    if (c == '\n') {
      text += "\\n";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

MetricsText& MetricsText::metric(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  text_ += "# HELP " + name_ + ' ';
  text_ += help;
  text_ += "\n# TYPE " + name_ + ' ';
  text_ += type;
  text_ += '\n';
  return *this;
}

MetricsText& MetricsText::sample(double value, const Labels& labels) {
  line("", value, labels);
  return *this;
}

MetricsText& MetricsText::histogram(const Histogram& values, const Labels& labels) {
  double total = 0.0;
  for (std::size_t bucket = 0; bucket <= Histogram::kBounds.size(); ++bucket) {
    total += static_cast<double>(values.count(bucket));
    const bool last = bucket == Histogram::kBounds.size();
    const std::string bound = last ? "+Inf" : number_text(Histogram::kBounds[bucket]);
    Labels with_bound = labels;
    with_bound.emplace_back("le", bound);
    line("_bucket", total, with_bound);
  }
  line("_sum", values.sum(), labels);
  line("_count", total, labels);
  return *this;
}

void MetricsText::line(std::string_view suffix, double value, const Labels& labels) {
  text_ += name_;
  text_ += suffix;
  char before = '{';
  for (const auto& [label, of] : labels) {
    text_ += before;
    text_ += label;
    text_ += "=\"" + escaped(of) + '"';
    before = ',';
  }
  if (!labels.empty()) text_ += '}';
  text_ += ' ' + number_text(value) + '\n';
}

namespace {

using Status = api::PlanOutcome::Status;

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

/// Returns the statuses whose series exist from the start, so that none first appears when it goes up. A
/// preflight (204) may name any route. Answers to a GET with a broken or endless body are not usual.
std::set<int> usual_statuses(const Route& route) {
  std::set<int> usual{200, 204, 405, 421, 500};
  if (!route.traits.without_token) usual.insert(401);
  if (route.takes_body()) usual.insert({400, 403, 408, 413, 415, 422, 499, 503});
  if (route.traits.events) usual.insert(406);
  usual.insert(route.traits.statuses.begin(), route.traits.statuses.end());
  return usual;
}

/// Returns the error's code if the exchange was refused. A probe that answers 503 while the server drains is
/// not refused.
std::string_view rejection(const Exchange& exchange) {
  const bool is_probe = exchange.route != nullptr && exchange.route->traits.without_token;
  const bool unready = is_probe && exchange.problem == api::name_of(api::ErrorCode::draining);
  return unready ? std::string_view() : exchange.problem;
}

double as_double(std::uint64_t count) { return static_cast<double>(count); }

/// The names of the values of Refusal, in their order.
constexpr std::array<std::string_view, kRefusals> kRefusalNames{"queue_full", "share", "too_late"};

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

void Metrics::write_requests(MetricsText& text) const {
  for (const Requests& requests : requests_) {
    for (int status = kFirstStatus; status < kFirstStatus + kStatuses; ++status) {
      const auto count = requests.by_status[static_cast<std::size_t>(status - kFirstStatus)].value();
      if (count == 0 && !requests.usual_statuses.contains(status)) continue;
      text.sample(as_double(count), {{"route", requests.label}, {"status", std::to_string(status)}});
    }
  }
}

/// The values that are not counted, but looked up when the text is written.
struct Metrics::Moment {
  const Gauges& load;
  const ProcessStats process;
};

/// A metric: either one sample without labels, or the samples that a function writes.
struct Metrics::Row {
  using Value = double (*)(const Metrics& all, const Moment& now);
  using Samples = void (*)(const Metrics& all, const Moment& now, MetricsText& text);

  constexpr Row(std::string_view row_name, std::string_view row_type, std::string_view row_help, Value one)
      : name(row_name), type(row_type), help(row_help), value(one) {}
  constexpr Row(std::string_view row_name, std::string_view row_type, std::string_view row_help, Samples all)
      : name(row_name), type(row_type), help(row_help), samples(all) {}

  std::string_view name;
  std::string_view type;
  std::string_view help;
  Value value = nullptr;
  Samples samples = nullptr;
};

/// Returns all metrics, in the order of their text.
std::span<const Metrics::Row> Metrics::table() {
  using M = const Metrics&;
  using N = const Moment&;
  using T = MetricsText&;
  static constexpr Row kRows[] = {
      {"fleetplan_build_info", "gauge", "The build that runs; always 1.",
       [](M, N, T text) {
         text.sample(1.0, {{"version", kVersion}, {"compiler", kCompiler}});
       }},
      {"fleetplan_requests_total", "counter", "Requests answered.",
       [](M all, N, T text) { all.write_requests(text); }},
      {"fleetplan_request_seconds", "histogram", "From a request's first byte to the end of its answer.",
       [](M all, N, T text) {
         for (const Requests& of : all.requests_) text.histogram(of.seconds, {{"route", of.label}});
       }},
      {"fleetplan_rejected_total", "counter", "Requests answered with a problem, except the 503 of /readyz.",
       [](M all, N, T text) {
         for (const auto& [reason, count] : all.rejected_) {
           text.sample(as_double(count.value()), {{"reason", reason}});
         }
       }},
      {"fleetplan_connections", "gauge", "Open connections.",
       [](M, N now, T text) {
         text.sample(as_double(now.load.connections), {{"port", "main"}})
             .sample(as_double(now.load.admin_connections), {{"port", "admin"}});
       }},
      {"fleetplan_workers", "gauge", "Plans and checks that can be computed at a time.",
       [](M, N now) { return as_double(now.load.workers); }},
      {"fleetplan_workers_busy", "gauge", "Plans and checks being computed.",
       [](M, N now) { return as_double(now.load.jobs.running); }},
      {"fleetplan_queue_depth", "gauge", "Jobs that wait for a worker.",
       [](M, N now) { return as_double(now.load.jobs.waiting); }},
      {"fleetplan_queue_wait_seconds", "histogram", "How long jobs waited for a worker.",
       [](M all, N, T text) { text.histogram(all.queue_seconds_); }},
      {"fleetplan_queue_lost_seconds_total", "counter", "Waiting of jobs that got no turn.",
       [](M all, N) { return all.queue_lost_seconds_.value(); }},
      {"fleetplan_jobs_refused_total", "counter", "Jobs that found no place, or would get no turn in time.",
       [](M, N now, T text) {
         for (std::size_t reason = 0; reason < kRefusals; ++reason) {
           text.sample(as_double(now.load.jobs.refused[reason]), {{"reason", kRefusalNames[reason]}});
         }
       }},
      {"fleetplan_improvements_paused", "gauge",
       "Anytime plans and simulations that wait while others compute.",
       [](M, N now) { return as_double(now.load.jobs.paused); }},
      {"fleetplan_improvements_ended_total", "counter",
       "Anytime plans returned before their time, as others waited.",
       [](M, N now) { return as_double(now.load.jobs.ended_early); }},
      {"fleetplan_late_seconds", "histogram",
       "How long after the end of their budget answers were made, of those that were late.",
       [](M all, N, T text) { text.histogram(all.late_seconds_); }},
      {"fleetplan_plans_total", "counter", "Plans returned.",
       [](M all, N, T text) {
         for (const Status status : {Status::solved, Status::partial, Status::none}) {
           const double count = as_double(all.plans_[static_cast<std::size_t>(status)].value());
           text.sample(count, {{"outcome", api::name_of(status)}});
         }
       }},
      {"fleetplan_plans_refused_total", "counter", "Plans that the checker rejected; each is a bug.",
       [](M all, N) { return as_double(all.plans_[static_cast<std::size_t>(Status::refused)].value()); }},
      {"fleetplan_plans_cancelled_total", "counter", "Plans whose client left before the answer.",
       [](M all, N) { return as_double(all.cancelled_.value()); }},
      {"fleetplan_plan_seconds", "histogram", "Time that planning took, of plans that were started.",
       [](M all, N, T text) { text.histogram(all.plan_seconds_); }},
      {"fleetplan_robots_total", "counter", "Robots of the plans.",
       [](M all, N, T text) {
         text.sample(as_double(all.planned_robots_.value()), {{"outcome", "planned"}});
         text.sample(as_double(all.unplanned_robots_.value()), {{"outcome", "unplanned"}});
       }},
      {"fleetplan_unplanned_robots_total", "counter", "Unplanned robots of the plans.",
       [](M all, N, T text) {
         for (std::size_t reason = 0; reason < all.unplanned_by_reason_.size(); ++reason) {
           text.sample(as_double(all.unplanned_by_reason_[reason].value()),
                       {{"reason", api::name_of(static_cast<core::Unplanned::Reason>(reason))}});
         }
       }},
      {"fleetplan_expansions_total", "counter", "Search labels expanded.",
       [](M all, N) { return as_double(all.expansions_.value()); }},
      {"fleetplan_map_cache_hits_total", "counter", "Maps of requests that were kept from earlier ones.",
       [](M, N now) { return as_double(now.load.maps.hits); }},
      {"fleetplan_map_cache_misses_total", "counter", "Maps of requests that had to be made.",
       [](M, N now) { return as_double(now.load.maps.misses); }},
      {"fleetplan_map_cache_maps", "gauge", "Maps that are kept or in use.",
       [](M, N now) { return as_double(now.load.maps.maps); }},
      {"fleetplan_map_cache_bytes", "gauge", "Memory of the maps that are kept or in use.",
       [](M, N now) { return as_double(now.load.maps.bytes); }},
      {"fleetplan_unsent_bytes", "gauge", "Memory of answers that clients have not accepted yet.",
       [](M, N now) { return as_double(now.load.unsent.bytes); }},
      {"fleetplan_unsent_dropped_total", "counter",
       "Answers dropped as their clients did not read them and others needed the memory.",
       [](M, N now) { return as_double(now.load.unsent.dropped); }},
      {"fleetplan_log_lines_dropped_total", "counter", "Log lines dropped: stderr was not read.",
       [](M, N now) { return as_double(now.load.log_dropped); }},
      {"process_cpu_seconds_total", "counter", "User and system CPU time.",
       [](M, N now) { return now.process.cpu_seconds; }},
      {"process_resident_memory_bytes", "gauge", "Physical memory.",
       [](M, N now) { return now.process.resident_bytes; }},
      {"process_virtual_memory_bytes", "gauge", "Virtual memory.",
       [](M, N now) { return now.process.virtual_bytes; }},
      {"process_open_fds", "gauge", "Open file descriptors.", [](M, N now) { return now.process.open_fds; }},
      {"process_max_fds", "gauge", "Maximum number of open file descriptors.",
       [](M, N now) { return now.process.max_fds; }},
      {"process_start_time_seconds", "gauge", "Start of the process, seconds since 1970.",
       [](M all, N) { return std::chrono::duration<double>(all.started_at_.time_since_epoch()).count(); }},
  };
  return kRows;
}

std::string Metrics::text(const Gauges& load) const {
  const Moment now{load, process_stats()};
  MetricsText text;
  for (const Row& row : table()) {
    text.metric(row.name, row.type, row.help);
    if (row.value != nullptr) {
      text.sample(row.value(*this, now));
    } else {
      row.samples(*this, now, text);
    }
  }
  return text.take();
}

}  // namespace fleetplan::server
