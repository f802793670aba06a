#include "server/ops/request_log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace fleetplan::server {

namespace {

using Line = nlohmann::ordered_json;

/// The line's members beside time and level, which the pattern puts in front.
constexpr const char* kPattern = R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v)";

/// Rounded to the third decimal, microseconds where these are milliseconds: enough, and short.
double rounded(double ms) { return std::round(ms * 1000.0) / 1000.0; }

void add_outcome(Line& line, const api::PlanOutcome& outcome) {
  line["outcome"] = api::name_of(outcome.status);
  line["planned"] = outcome.planned;
  line["unplanned"] = outcome.unplanned;
  line["flowtime"] = rounded(outcome.flowtime);
  if (outcome.plan_seconds) line["plan_ms"] = rounded(*outcome.plan_seconds * 1000.0);
}

void write(spdlog::logger& logger, spdlog::level::level_enum level, const Line& line) {
  // A client's path may not be UTF-8; such bytes are replaced.
  const std::string json = line.dump(-1, ' ', false, Line::error_handler_t::replace);
  logger.log(level, spdlog::string_view_t(json.data() + 1, json.size() - 1));  // without the opening brace
}

}  // namespace

RequestLog::RequestLog(const std::string& level)
    : logger_(
          std::make_shared<spdlog::logger>("fleetplan", std::make_shared<spdlog::sinks::stderr_sink_mt>())) {
  logger_->set_pattern(kPattern, spdlog::pattern_time_type::utc);
  logger_->set_level(spdlog::level::from_str(level));
}

void RequestLog::request(const RequestRecord& record) const {
  const auto level = record.status >= 500 && record.status != 503 ? spdlog::level::err
                     : record.admin                               ? spdlog::level::debug
                                                                  : spdlog::level::info;
  if (!logger_->should_log(level)) return;
  Line line;
  line["id"] = record.id;
  line["method"] = record.method;
  line["path"] = record.path;
  line["status"] = record.status;
  line["bytes_in"] = record.bytes_in;
  line["bytes_out"] = record.bytes_out;
  line["ms"] = rounded(record.ms);
  if (record.queue_ms) line["queue_ms"] = rounded(*record.queue_ms);
  if (record.outcome) add_outcome(line, *record.outcome);
  if (!record.problem.empty()) line["code"] = record.problem;
  line["peer"] = record.peer;
  write(*logger_, level, line);
}

void RequestLog::info(std::string_view message, Members members) const {
  if (!logger_->should_log(spdlog::level::info)) return;
  Line line;
  line["message"] = message;
  for (const auto& [name, value] : members) {
    std::visit([&, key = std::string(name)](const auto& known) { line[key] = known; }, value);
  }
  write(*logger_, spdlog::level::info, line);
}

void RequestLog::error(std::string_view message, std::string_view request_id) const {
  if (!logger_->should_log(spdlog::level::err)) return;
  Line line;
  if (!request_id.empty()) line["id"] = request_id;
  line["message"] = message;
  write(*logger_, spdlog::level::err, line);
}

}  // namespace fleetplan::server
