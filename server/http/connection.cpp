#include "server/http/connection.h"

#include <algorithm>
#include <utility>

#include "server/http/answer_text.h"
#include "server/http/body_reader.h"
#include "server/http/request_id.h"
#include "server/http/text.h"
#include "server/http/under_way.h"

namespace fleetplan::server {

namespace {

using api::ErrorCode;
using Clock = Socket::Clock;

/// A refused body up to this size is read and dropped to keep the connection; a larger one costs it.
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

DirectAnswer problem(const Exchange& exchange, const Refusal& refusal) {
  return {api::problem_reply(refusal.code, refusal.detail, exchange.request_id), refusal.fields};
}

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
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
  std::uint64_t bytes_out = 0;
  if (const auto answer = read_request(exchange)) {
    bytes_out = write(exchange, *answer);
  } else if (open_) {
    ExchangeStream stream(exchange);
    const bool usable = context_.answer(exchange, stream);
    open_ = stream.flush() && usable;
    bytes_out = stream.written();
  } else {
    return;  // it left before it asked for anything
  }
  if (exchange.abandoned) {
    exchange.status = 499;
    exchange.problem = {};  // no answer went out that could have one
  }
  context_.metrics.count(exchange);
  log(exchange, bytes_out);
}

std::optional<DirectAnswer> Connection::read_request(Exchange& exchange) {
  if (const auto refusal = read_head(exchange)) {
    exchange.close = unread_ = true;
    return problem(exchange, *refusal);
  }
  if (!open_) return std::nullopt;
  const RequestHead& head = exchange.head;
  exchange.close = !head.wants_keep_alive();
  exchange.fields = context_.cross_origin.answer_fields(head);
  exchange.route = route_of(head, context_.port, context_.files);
  if (auto answer = answer_to_head(exchange)) {
    const bool droppable = !head.chunked && head.content_length.value_or(0) <= kMaxDropped;
    if (has_body(head) && (!droppable || expects_continue(head))) exchange.close = unread_ = true;
    return answer;
  }
  const auto refusal = read_content(exchange);
  exchange.received_at = Clock::now();
  if (refusal) return problem(exchange, *refusal);
  return std::nullopt;
}

/// What can be answered before a byte of the body is read.
std::optional<DirectAnswer> Connection::answer_to_head(const Exchange& exchange) const {
  const Route& route = exchange.route;
  if (route.endpoint != Endpoint::unknown && context_.cross_origin.is_preflight(exchange.head)) {
    return DirectAnswer{{204, "", ""}, CrossOrigin::preflight_fields(allowed_methods(route.endpoint))};
  }
  const auto refusal = admission_fault(exchange.head, route, context_.settings, context_.draining);
  if (refusal) return problem(exchange, *refusal);
  return std::nullopt;
}

std::optional<Refusal> Connection::read_head(Exchange& exchange) {
  const auto deadline = exchange.begun_at + context_.settings.read_timeout;
  // Empty lines before a request are to be ignored (RFC 9112, 2.2).
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
    return Refusal{ErrorCode::malformed_request, "The lines of a request's head end in CR LF."};
  }
  if (input_.size() > kMaxHeadBytes &&
      (state != HeadScanner::State::complete || scanner.size() > kMaxHeadBytes)) {
    const BadHead bad = too_large_head(input_);
    return Refusal{code_of(bad.kind), bad.detail};
  }
  if (state == HeadScanner::State::incomplete) {
    return Refusal{ErrorCode::request_timeout, "The request's head did not come within " +
                                                   std::to_string(context_.settings.read_timeout.count()) +
                                                   " ms."};
  }
  auto parsed = parse_request_head(std::string_view(input_).substr(0, scanner.size()));
  input_.erase(0, scanner.size());
  if (const auto* bad = std::get_if<BadHead>(&parsed)) {
    return Refusal{code_of(bad->kind), bad->detail};
  }
  exchange.head = std::get<RequestHead>(std::move(parsed));
  const std::string sent_id = exchange.head.field("x-request-id");
  if (is_well_formed_request_id(sent_id)) exchange.request_id = sent_id;
  return std::nullopt;
}

std::optional<Refusal> Connection::read_content(Exchange& exchange) {
  const RequestHead& head = exchange.head;
  if (!has_body(head)) return std::nullopt;
  if (expects_continue(head) && input_.empty()) open_ = socket_.write_all("HTTP/1.1 100 Continue\r\n\r\n");
  auto read = read_body(socket_, input_, head, context_.settings.limits.max_body, *exchange.memory,
                        context_.settings.read_timeout);
  if (auto* fault = std::get_if<BodyFault>(&read)) {
    exchange.close = unread_ = true;
    return Refusal{code_of(fault->kind), fault->detail};
  }
  exchange.body = std::get<std::string>(std::move(read));
  return std::nullopt;
}

std::uint64_t Connection::write(Exchange& exchange, const DirectAnswer& answer) {
  if (context_.draining) exchange.close = true;
  exchange.status = answer.reply.status;
  exchange.problem = answer.reply.problem;
  const std::string text = answer_text(exchange, answer.reply, answer.fields);
  open_ = socket_.write_all(text) && open_;
  if (open_ && !exchange.close && exchange.body.empty() && has_body(exchange.head)) drop_body(exchange);
  return text.size();
}

void Connection::drop_body(Exchange& exchange) {
  const auto read = read_body(socket_, input_, exchange.head, kMaxDropped, *exchange.memory,
                              context_.settings.read_timeout);
  if (std::holds_alternative<BodyFault>(read)) exchange.close = unread_ = true;
}

void Connection::log(const Exchange& exchange, std::uint64_t bytes_out) const {
  RequestRecord record;
  record.id = exchange.request_id;
  record.method = exchange.head.method;
  record.path = exchange.head.raw_path;
  record.status = exchange.status;
  record.bytes_in = exchange.body.size();
  record.bytes_out = bytes_out;
  record.ms = ms_between(exchange.begun_at, Clock::now());
  record.queue_ms = exchange.queue_ms;
  record.problem = exchange.problem;
  record.outcome = exchange.outcome;
  record.peer = peer_;
  record.admin = context_.port == Port::admin;
  context_.log.request(record);
}

}  // namespace fleetplan::server
