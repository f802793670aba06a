#include "server/ops/request_log.h"

#include <poll.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <new>
#include <string_view>
#include <thread>
#include <utility>

#include "api/endpoints/pipeline.h"
#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/json/printable.h"

namespace fleetplan::server {

namespace {

/// Writes a text to a descriptor. Returns false when it takes no more.
bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written > 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {  // another process has made it non-blocking
      pollfd wanted{fd, POLLOUT, 0};
      ::poll(&wanted, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

std::uint64_t lines_in(std::string_view text) {
  return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

struct LogQueue::State {
  State(int to, std::size_t max) : fd(to), max_bytes(max) {}

  /// Writes lines until the queue ends.
  void write() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [this] { return ending || !waiting.empty(); });
      if (waiting.empty()) return;
      const std::string text = std::exchange(waiting, {});
      writing = true;
      lock.unlock();
      const bool written = write_all(fd, text);
      lock.lock();
      writing = false;
      if (!written) dropped += lines_in(text);
      changed.notify_all();
    }
  }

  const int fd;
  const std::size_t max_bytes;
  std::mutex mutex;  // guards all below
  std::condition_variable changed;
  std::string waiting;  // lines that wait
  std::uint64_t dropped = 0;
  bool writing = false;
  bool ending = false;
};

LogQueue::LogQueue(int fd, std::size_t max_bytes) : state_(std::make_shared<State>(fd, max_bytes)) {
  std::thread([state = state_] { state->write(); }).detach();
}

LogQueue::~LogQueue() {
  flush();
  const std::lock_guard lock(state_->mutex);
  state_->ending = true;
  state_->changed.notify_all();
}

void LogQueue::push(std::string line) {
  const std::lock_guard lock(state_->mutex);
  if (state_->waiting.size() + line.size() > state_->max_bytes) {
    ++state_->dropped;
    return;
  }
  if (state_->waiting.empty()) {
    state_->waiting = std::move(line);
  } else {
    state_->waiting += line;
  }
  if (!state_->writing) state_->changed.notify_all();
}

void LogQueue::flush(std::chrono::milliseconds patience) const {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait_for(lock, patience, [this] { return state_->waiting.empty() && !state_->writing; });
}

std::uint64_t LogQueue::dropped() const {
  const std::lock_guard lock(state_->mutex);
  return state_->dropped;
}

namespace {

using api::JsonWriter;

/// The pattern of a line: time and level, then its members, without its opening brace.
constexpr const char* kPattern = R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v)";

/// The most bytes of lines that wait for a reader.
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

/// Rounds milliseconds to the third decimal, which is enough, and short.
double rounded(double ms) { return std::round(ms * 1000.0) / 1000.0; }

/// Returns the end of what proxies forwarded, to which the nearest proxy adds. Clients can make the rest as
/// long as a head.
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
  const std::string json = api::printable(line.end_object().take());
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

api::Reply internal_error(const RequestLog& log, const std::string& request_id,
                          const std::exception_ptr& failure) {
  std::string what = "an exception of an unknown type";
  try {
    std::rethrow_exception(failure);
  } catch (const std::bad_alloc&) {
    log.warn("out of memory", {{"id", request_id}});
    return api::out_of_memory(request_id);
  } catch (const std::exception& known) {
    what = known.what();
  } catch (...) {  // NOLINT(bugprone-empty-catch): reported below
  }
  log.error(what, request_id);
  return api::problem_reply(api::ErrorCode::internal_error,
                            "A bug in the service; its log has more under this request_id.", request_id);
}

}  // namespace fleetplan::server
