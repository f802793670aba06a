#include "server/ops/request_log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "api/json/json_writer.h"

namespace fleetplan::server {

namespace {

using api::JsonWriter;

/// Time and level, then the members of a line, without its opening brace.
constexpr const char* kPattern = R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v)";

/// Bytes of the lines that wait for a reader.
constexpr std::size_t kMaxWaiting = 1 << 20;

class QueueSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit QueueSink(std::shared_ptr<LogQueue> queue) : queue_(std::move(queue)) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    queue_->push({line.data(), line.size()});
  }
  void flush_() override { queue_->flush(); }

  std::shared_ptr<LogQueue> queue_;
};

/// Rounded to the third decimal, microseconds where these are milliseconds: enough, and short.
double rounded(double ms) { return std::round(ms * 1000.0) / 1000.0; }

/// The end of what proxies forwarded, to which the nearest one adds: clients can make the rest as long as a
/// head.
std::string_view nearest(std::string_view forwarded) {
  constexpr std::size_t kMaxLength = 256;
  forwarded.remove_prefix(forwarded.size() - std::min(forwarded.size(), kMaxLength));
  return forwarded;
}

void add_outcome(JsonWriter& line, const api::PlanOutcome& outcome) {
  line.member("outcome", api::name_of(outcome.status));
  line.member("planned", outcome.planned).member("unplanned", outcome.unplanned);
  line.member("flowtime", rounded(outcome.flowtime));
  if (outcome.plan_seconds) line.member("plan_ms", rounded(*outcome.plan_seconds * 1000.0));
}

void write(spdlog::logger& logger, spdlog::level::level_enum level, JsonWriter& line) {
  const std::string json = line.end_object().take();
  logger.log(level, spdlog::string_view_t(json.data() + 1, json.size() - 1));  // without the opening brace
}

void write_event(spdlog::logger& logger, spdlog::level::level_enum level, std::string_view message,
                 RequestLog::Members members) {
  if (!logger.should_log(level)) return;
  JsonWriter line;
  line.begin_object().member("message", message);
  for (const auto& [name, value] : members) {
    line.key(name);
    std::visit([&](const auto& held) { line.value(held); }, value);
  }
  write(logger, level, line);
}

}  // namespace

RequestLog::RequestLog(const std::string& level, int fd)
    : queue_(std::make_shared<LogQueue>(fd, kMaxWaiting)),
      logger_(std::make_shared<spdlog::logger>("fleetplan", std::make_shared<QueueSink>(queue_))) {
  logger_->set_pattern(kPattern, spdlog::pattern_time_type::utc);
  logger_->set_level(spdlog::level::from_str(level));
}

void RequestLog::request(const RequestRecord& record) const {
  const auto level = record.status >= 500 && record.status != 503 ? spdlog::level::err
                     : record.admin                               ? spdlog::level::debug
                                                                  : spdlog::level::info;
  if (!logger_->should_log(level)) return;
  JsonWriter line;
  line.begin_object().member("id", record.id);
  if (!record.trace_id.empty()) line.member("trace_id", record.trace_id);
  line.member("method", record.method).member("path", record.path);
  line.member("status", record.status);
  line.member("bytes_in", record.bytes_in).member("bytes_out", record.bytes_out);
  line.member("ms", rounded(record.ms));
  if (record.queue_ms) line.member("queue_ms", rounded(*record.queue_ms));
  if (record.outcome) add_outcome(line, *record.outcome);
  if (!record.problem.empty()) line.member("code", record.problem);
  line.member("peer", record.peer);
  if (!record.forwarded.empty()) line.member("forwarded", nearest(record.forwarded));
  write(*logger_, level, line);
}

void RequestLog::info(std::string_view message, Members members) const {
  write_event(*logger_, spdlog::level::info, message, members);
}

void RequestLog::warn(std::string_view message, Members members) const {
  write_event(*logger_, spdlog::level::warn, message, members);
}

void RequestLog::error(std::string_view message, std::string_view request_id) const {
  if (!logger_->should_log(spdlog::level::err)) return;
  JsonWriter line;
  line.begin_object();
  if (!request_id.empty()) line.member("id", request_id);
  line.member("message", message);
  write(*logger_, spdlog::level::err, line);
}

}  // namespace fleetplan::server
