#include "server/http/guard/connection.h"

#include <algorithm>
#include <utility>

#include "server/http/guard/body_reader.h"
#include "server/http/steps/request_id.h"
#include "server/http/text.h"

namespace fleetplan::server {

namespace {

using api::ErrorCode;
using Clock = Socket::Clock;

/// The body of a refused request is read and dropped up to this size; with a larger one, the connection ends.
constexpr std::uint64_t kMaxDropped = 1 << 20;

ErrorCode code_of(BadHead::Kind kind) {
  switch (kind) {
    case BadHead::Kind::target_too_long:
      return ErrorCode::target_too_long;
    case BadHead::Kind::too_large:
      return ErrorCode::head_too_large;
    default:
      return ErrorCode::malformed_request;
  }
}

ErrorCode code_of(BodyFault::Kind kind) {
  switch (kind) {
    case BodyFault::Kind::too_large:
      return ErrorCode::body_too_large;
    case BodyFault::Kind::no_room:
      return ErrorCode::overloaded;
    case BodyFault::Kind::too_slow:
      return ErrorCode::request_timeout;
    case BodyFault::Kind::stopped:
      return ErrorCode::draining;
    default:
      return ErrorCode::malformed_request;
  }
}

bool has_body(const RequestHead& head) { return head.chunked || head.content_length.value_or(0) > 0; }

bool expects_continue(const RequestHead& head) {
  return !head.http_1_0 && lower_case(head.field("expect")) == "100-continue";
}

}  // namespace

Connection::Connection(int fd, ConnectionContext context)
    : context_(std::move(context)), socket_(fd, context_.stop_fd), peer_(socket_.peer()) {}

void Connection::serve() {
  while (open_ && await_request()) {
    const UnderWay counted(context_.exchanges);
    Exchange exchange;
    exchange.socket = &socket_;
    exchange.memory.emplace(context_.body_memory);
    exchange.begun_at = Clock::now();
    serve_exchange(exchange);
    open_ = open_ && !exchange.close;
  }
  if (unread_ || socket_.has_input()) socket_.linger();
}

bool Connection::await_request() {
  return !input_.empty() ||
         socket_.read_some(input_, Clock::now() + context_.settings.idle_timeout) == Socket::Read::some;
}

void Connection::serve_exchange(Exchange& exchange) {
  Sent sent;
  if (const auto answer = read_request(exchange)) {
    sent = send(exchange, *answer);
  } else if (open_) {
    sent = context_.answer(exchange);
  } else {
    return;  // the client left before its request was complete
  }
  open_ = open_ && sent.usable;
  context_.steps.end(exchange, sent.bytes, peer_);
}

/// The answer, if it needs no handler.
std::optional<DirectAnswer> Connection::read_request(Exchange& exchange) {
  if (auto bad_head = read_head(exchange)) {
    exchange.close = unread_ = true;
    return bad_head;
  }
  if (!open_) return std::nullopt;
  const RequestHead& head = exchange.head;
  exchange.close = !head.keeps_alive();
  context_.steps.begin(exchange);
  if (auto answer = context_.steps.answer_to_head(exchange)) {
    const bool droppable = !head.chunked && head.content_length.value_or(0) <= kMaxDropped;
    if (has_body(head) && (!droppable || expects_continue(head))) exchange.close = unread_ = true;
    return answer;
  }
  auto bad_body = read_content(exchange);
  exchange.received_at = Clock::now();
  return bad_body;
}

std::optional<DirectAnswer> Connection::read_head(Exchange& exchange) {
  const auto deadline = exchange.begun_at + context_.settings.read_timeout;
  // Empty lines before a request must be ignored (RFC 9112, 2.2).
  const auto skip_empty_lines = [&] {
    input_.erase(0, std::min(input_.find_first_not_of("\r\n"), input_.size()));
  };
  skip_empty_lines();
  HeadScanner scanner;
  HeadScanner::State state{};
  while ((state = scanner.scan(input_)) == HeadScanner::State::incomplete) {
    if (input_.size() > kMaxHeadBytes) break;
    const auto read = socket_.read_some(input_, deadline);
    if (read == Socket::Read::timeout && !input_.empty()) break;
    if (read != Socket::Read::some) {
      open_ = false;
      return std::nullopt;
    }
    if (scanner.size() == 0) skip_empty_lines();
  }
  exchange.request_id = make_request_id();
  if (state == HeadScanner::State::malformed) {
    return refusal(exchange, ErrorCode::malformed_request,
                   "The lines of a request's head must end in CR LF.");
  }
  if (input_.size() > kMaxHeadBytes &&
      (state != HeadScanner::State::complete || scanner.size() > kMaxHeadBytes)) {
    const BadHead bad = too_large_head(input_);
    return refusal(exchange, code_of(bad.kind), bad.detail);
  }
  if (state == HeadScanner::State::incomplete) {
    return refusal(exchange, ErrorCode::request_timeout,
                   "The request's head did not arrive within " +
                       std::to_string(context_.settings.read_timeout.count()) + " ms.");
  }
  auto parsed = parse_request_head(std::string_view(input_).substr(0, scanner.size()));
  input_.erase(0, scanner.size());
  if (const auto* bad = std::get_if<BadHead>(&parsed)) {
    return refusal(exchange, code_of(bad->kind), bad->detail);
  }
  exchange.head = std::get<RequestHead>(std::move(parsed));
  return std::nullopt;
}

std::optional<DirectAnswer> Connection::read_content(Exchange& exchange) {
  const RequestHead& head = exchange.head;
  if (!has_body(head)) return std::nullopt;
  if (expects_continue(head) && input_.empty()) open_ = socket_.write_all("HTTP/1.1 100 Continue\r\n\r\n");
  auto read = read_body(socket_, input_, head, context_.settings.limits.max_body, *exchange.memory,
                        context_.settings.read_timeout);
  if (auto* fault = std::get_if<BodyFault>(&read)) {
    exchange.close = unread_ = true;
    return refusal(exchange, code_of(fault->kind), fault->detail);
  }
  exchange.body = std::get<std::string>(std::move(read));
  return std::nullopt;
}

Sent Connection::send(Exchange& exchange, const DirectAnswer& answer) {
  if (context_.draining) exchange.close = true;
  exchange.status = answer.reply.status;
  exchange.problem = answer.reply.problem;
  const std::string text = answer_text(exchange, answer);
  const bool usable = socket_.write_all(text);
  if (usable && !exchange.close && exchange.body.empty() && has_body(exchange.head)) drop_body(exchange);
  return {text.size(), usable};
}

void Connection::drop_body(Exchange& exchange) {
  const auto read = read_body(socket_, input_, exchange.head, kMaxDropped, *exchange.memory,
                              context_.settings.read_timeout);
  if (std::holds_alternative<BodyFault>(read)) exchange.close = unread_ = true;
}

}  // namespace fleetplan::server
