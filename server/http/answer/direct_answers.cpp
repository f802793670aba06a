#include "server/http/answer/direct_answers.h"

#include <array>
#include <charconv>
#include <string_view>
#include <utility>

namespace fleetplan::server {

namespace {

std::string_view reason_phrase(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 406:
      return "Not Acceptable";
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 415:
      return "Unsupported Media Type";
    case 421:
      return "Misdirected Request";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "Error";
  }
}

}  // namespace

DirectAnswer refusal(const Exchange& exchange, api::ErrorCode code, const std::string& detail,
                     HeaderFields fields) {
  return {api::problem_reply(code, detail, exchange.request_id), std::move(fields)};
}

HeaderFields common_fields(const Exchange& exchange) {
  HeaderFields fields{{"X-Request-Id", exchange.request_id}, {"X-Content-Type-Options", "nosniff"}};
  fields.insert(fields.end(), exchange.fields.begin(), exchange.fields.end());
  if (exchange.status == 503) fields.emplace_back("Retry-After", std::to_string(exchange.retry_after_s));
  if (exchange.close) {
    fields.emplace_back("Connection", "close");
  } else if (exchange.head.http_1_0) {
    fields.emplace_back("Connection", "keep-alive");
  }
  return fields;
}

std::string answer_head(const Exchange& exchange, int status, const HeaderFields& further) {
  std::string text = "HTTP/1.1 " + std::to_string(status) + ' ';
  text += reason_phrase(status);
  text += "\r\n";
  const auto add = [&](const std::string& name, const std::string& value) {
    text += name + ": " + value + "\r\n";
  };
  for (const auto& [name, value] : common_fields(exchange)) add(name, value);
  for (const auto& [name, value] : further) add(name, value);
  return text + "\r\n";
}

std::string answer_text(const Exchange& exchange, const DirectAnswer& answer) {
  const api::Reply& reply = answer.reply;
  HeaderFields fields = answer.fields;
  if (reply.status != 204) {
    fields.emplace_back("Content-Type", reply.content_type);
    fields.emplace_back("Content-Length", std::to_string(reply.body.size()));
  }
  std::string text = answer_head(exchange, reply.status, fields);
  if (exchange.head.method != "HEAD") text += reply.body;
  return text;
}

namespace {

std::string hexadecimal(std::size_t number) {
  std::array<char, 2 * sizeof number> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16).ptr;
  return {digits.data(), end};
}

/// The time between two attempts to send what the client did not accept.
constexpr std::chrono::milliseconds kRetry{20};

}  // namespace

EventStream::EventStream(Exchange& exchange, const char* last)
    : exchange_(exchange), chunked_(!exchange.head.http_1_0), last_(last) {}

EventStream::~EventStream() { stop_writing(); }

void EventStream::begin(const api::PlanProgress& progress) {
  progress_ = progress;
  if (!chunked_) exchange_.close = true;  // the end of the connection marks the end of the answer
  writer_ = std::thread([this] { write_events(); });
  begun_ = true;
}

void EventStream::progress(const api::PlanProgress& progress) {
  const std::lock_guard lock(mutex_);
  progress_ = progress;
}

void EventStream::incumbent(std::string answer) {
  {
    const std::lock_guard lock(mutex_);
    incumbent_ = std::move(answer);
  }
  changed_.notify_one();
}

void EventStream::end(const api::Reply& reply) {
  stop_writing();
  if (!failed_ && !exchange_.abandoned) {
    const std::string last = event(reply.status == 200 ? last_ : "problem", reply.body);
    send(chunked_ ? last + "0\r\n\r\n" : last);
  }
  if (failed_) exchange_.close = true;
  exchange_.streamed = sent_;
}

void EventStream::stop_writing() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  writer_.join();
}

void EventStream::write_events() {
  std::string due = head();
  std::unique_lock lock(mutex_);
  do {
    const bool is_behind = exchange_.unsent->has_rest();
    const api::PlanProgress progress = progress_;
    const std::optional<std::string> incumbent =
        is_behind ? std::nullopt : std::exchange(incumbent_, std::nullopt);
    lock.unlock();
    if (is_behind) {
      write_rest();
    } else {
      const std::chrono::duration<double, std::milli> elapsed =
          Exchange::Clock::now() - exchange_.received_at;
      due += event("progress", api::write_progress(progress, elapsed.count()));
      if (incumbent) due += event("incumbent", *incumbent);
      send(due);
      due = std::string();
    }
    const bool waits_for_client = exchange_.unsent->has_rest();
    lock.lock();
    changed_.wait_for(lock, waits_for_client ? kRetry : kPeriod,
                      [&] { return ending_ || (incumbent_ && !waits_for_client); });
  } while (!ending_ && !failed_);
}

void EventStream::send(std::string_view text) {
  sent_ += text.size();
  failed_ = !exchange_.send(text);
  patience_.emplace(exchange_.unsent->rest());
  deadline_ = patience_->deadline();
  if (failed_) exchange_.socket->hang_up();  // the plan is stopped, too, then
}

void EventStream::write_rest() {
  const auto sent = exchange_.unsent->send_rest();
  if (sent && *sent > 0) deadline_ = patience_->deadline();
  failed_ = !sent || Exchange::Clock::now() >= deadline_;
  if (failed_) exchange_.socket->hang_up();
}

std::string EventStream::head() const {
  // Caches and proxies must pass on every event at once.
  HeaderFields fields{
      {"Content-Type", "text/event-stream"}, {"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
  if (chunked_) fields.emplace_back("Transfer-Encoding", "chunked");
  return answer_head(exchange_, 200, fields);
}

std::string EventStream::event(std::string_view name, std::string_view data) const {
  const std::array<std::string_view, 5> parts{"event: ", name, "\ndata: ", data, "\n\n"};
  std::size_t size = 0;
  for (const std::string_view part : parts) size += part.size();
  std::string text;
  text.reserve(size + 32);
  if (chunked_) text.append(hexadecimal(size)).append("\r\n");
  for (const std::string_view part : parts) text.append(part);
  if (chunked_) text.append("\r\n");
  return text;
}

}  // namespace fleetplan::server
