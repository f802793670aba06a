
#include "server/connections/connection.h"

#include <algorithm>
#include <utility>

#include "server/http/request/request_head.h"
#include "server/http/text.h"

namespace fleetplan::server {

namespace {

using api::ErrorCode;

/// The most bytes of a refused request's body that are read and dropped. If the body is larger, the
/// connection ends.
constexpr std::uint64_t kMaxDropped = 1 << 20;
/// The least rate of a body. A body that arrives more slowly falls behind; the read timeout limits how far.
constexpr std::uint64_t kLeastBytesPerMs = 100;
/// How long input is dropped after the last answer, so that the answer arrives. A close with unread input
/// would reset the connection and could lose the answer.
constexpr std::chrono::seconds kLinger{3};

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

bool has_body(const RequestHead& head) { return head.chunked || head.content_length.value_or(0) > 0; }

bool expects_continue(const RequestHead& head) {
  return !head.http_1_0 && lower_case(head.field("expect")) == "100-continue";
}

/// Skips empty lines before a request, which must be ignored (RFC 9112, 2.2). Returns their bytes.
std::size_t skip_empty_lines(std::string& input) {
  std::size_t end = 0;
  while (input.compare(end, 2, "\r\n") == 0) end += 2;
  input.erase(0, end);
  return end;
}

}  // namespace

Connection::Connection(int fd, ConnectionContext context)
    : context_(std::move(context)), socket_(fd), peer_(socket_.peer()) {
  begin(Phase::idle, Clock::now() + context_.settings.idle_timeout);
}

std::optional<Connection::Wait> Connection::go_on() {
  bool goes_on = true;
  while (goes_on && phase_ != Phase::over) {
    switch (phase_) {
      case Phase::idle:
        goes_on = idle();
        break;
      case Phase::head:
        goes_on = head();
        break;
      case Phase::body:
        goes_on = body();
        break;
      case Phase::sending:
        goes_on = sending();
        break;
      case Phase::dropping:
        goes_on = dropping();
        break;
      case Phase::lingering:
        goes_on = lingering();
        break;
      case Phase::over:
        break;
    }
  }
  return phase_ == Phase::over ? std::nullopt : std::optional(wait());
}

Connection::Wait Connection::wait() const {
  return {phase_ != Phase::sending, deadline_, since_, stop_seen_};
}

void Connection::begin(Phase phase, Clock::time_point deadline) {
  phase_ = phase;
  since_ = Clock::now();
  deadline_ = deadline;
}

Connection::Input Connection::receive() {
  switch (socket_.read_some(input_)) {
    case Socket::Read::some:
      return Input::some;
    case Socket::Read::end:
      return Input::end;
    case Socket::Read::nothing:
      break;
  }
  stop_seen_ = context_.stop.raised();
  if (stop_seen_) return Input::stopped;
  return Clock::now() >= deadline_ ? Input::timeout : Input::nothing;
}

bool Connection::idle() {
  const Input input = input_.empty() ? receive() : Input::some;
  if (input == Input::nothing) return false;
  if (input == Input::some) {
    begin_exchange();
  } else {
    phase_ = Phase::over;
  }
  return true;
}

void Connection::begin_exchange() {
  under_way_.emplace(context_.exchanges);
  exchange_.emplace();
  exchange_->socket = &socket_;
  exchange_->unsent.emplace(context_.unsent_answers, socket_);
  exchange_->memory.emplace(context_.body_memory);
  exchange_->begun_at = Clock::now();
  scanner_ = {};
  empty_line_bytes_ = 0;
  begin(Phase::head, exchange_->begun_at + context_.settings.read_timeout);
}

bool Connection::head() {
  if (scanner_.size() == 0) empty_line_bytes_ += skip_empty_lines(input_);
  if (empty_line_bytes_ > kMaxHeadBytes) {
    exchange_->request_id = make_request_id();
    refuse(ErrorCode::malformed_request, "There are too many empty lines before the request.");
    return true;
  }
  const bool in_empty_line = scanner_.size() == 0 && input_ == "\r";
  const auto state = in_empty_line ? HeadScanner::State::incomplete : scanner_.scan(input_);
  if (state == HeadScanner::State::incomplete && input_.size() <= kMaxHeadBytes) {
    const Input input = receive();
    if (input == Input::some && !exchange_->memory->grow_to(input_.size())) {
      exchange_->request_id = make_request_id();
      refuse(ErrorCode::overloaded, BodyMemory::kFull);
      return true;
    }
    if (input == Input::some) return true;
    if (input == Input::nothing) return false;
    if (input != Input::timeout || input_.empty()) {  // the client left before its request was complete
      phase_ = Phase::over;
      return true;
    }
  }
  exchange_->request_id = make_request_id();
  judge_head(state);
  return true;
}

void Connection::judge_head(HeadScanner::State state) {
  if (state == HeadScanner::State::malformed) {
    return refuse(ErrorCode::malformed_request, "The lines of a request's head must end in CR LF.");
  }
  if (input_.size() > kMaxHeadBytes &&
      (state != HeadScanner::State::complete || scanner_.size() > kMaxHeadBytes)) {
    const BadHead bad = too_large_head(input_);
    return refuse(code_of(bad.kind), bad.detail);
  }
  if (state == HeadScanner::State::incomplete) {
    return refuse(ErrorCode::request_timeout, "The request's head did not arrive within " +
                                                  std::to_string(context_.settings.read_timeout.count()) +
                                                  " ms.");
  }
  auto parsed = parse_request_head(std::string_view(input_).substr(0, scanner_.size()));
  input_.erase(0, scanner_.size());
  if (const auto* bad = std::get_if<BadHead>(&parsed)) return refuse(code_of(bad->kind), bad->detail);
  exchange_->head = std::get<RequestHead>(std::move(parsed));
  begin_body();
}

/// Begins to read the body. Answers at once if the answer needs no body.
void Connection::begin_body() {
  const RequestHead& head = exchange_->head;
  exchange_->close = !head.keeps_alive();
  context_.steps.begin(*exchange_);
  if (const auto answer = context_.steps.answer_to_head(*exchange_)) {
    const bool droppable = !head.chunked && head.content_length.value_or(0) <= kMaxDropped;
    if (has_body(head) && (!droppable || expects_continue(head))) exchange_->close = unread_ = true;
    if (has_body(head) && !exchange_->close) body_.emplace(head, kMaxDropped, nullptr);
    return answer_directly(*answer);
  }
  if (!has_body(head)) return end_body();
  if (expects_continue(head) && input_.empty()) exchange_->send("HTTP/1.1 100 Continue\r\n\r\n");
  body_.emplace(head, context_.settings.limits.max_body, &*exchange_->memory);
  body_bytes_ = 0;
  begin(Phase::body, {});
  set_body_deadline();
}

void Connection::set_body_deadline() {
  const auto whole = since_ + std::chrono::milliseconds(body_bytes_ / kLeastBytesPerMs);
  deadline_ = std::min(whole, Clock::now()) + context_.settings.read_timeout;
}

bool Connection::body() {
  switch (body_->take(input_)) {
    case BodyReader::State::complete:
      exchange_->bytes_in = body_->size();
      exchange_->body = body_->take_body();
      body_.reset();
      end_body();
      return true;
    case BodyReader::State::failed:
      refuse(body_->fault());
      return true;
    case BodyReader::State::incomplete:
      break;
  }
  if (body_->size() > body_bytes_) {  // the sizes of chunks, extensions and trailers are no progress
    body_bytes_ = body_->size();
    set_body_deadline();
  }
  const Input input = receive();
  if (input == Input::end) {
    refuse(malformed_body("The body ended early."));
  } else if (input == Input::stopped) {
    refuse({BodyFault::Kind::stopped, api::kDrainingDetail});
  } else if (input == Input::timeout) {
    refuse({BodyFault::Kind::too_slow, "The body did not arrive in time: it may pause for " +
                                           std::to_string(context_.settings.read_timeout.count()) +
                                           " ms and fall as far behind " + std::to_string(kLeastBytesPerMs) +
                                           " kB/s."});
  }
  return input != Input::nothing;
}

/// Ends the body: the request is complete.
void Connection::end_body() {
  exchange_->received_at = Clock::now();
  answer();
}

void Connection::refuse(const BodyFault& fault) { refuse(code_of(fault.kind), fault.detail); }

/// Refuses the request. After this, the input cannot be understood.
void Connection::refuse(ErrorCode code, const std::string& detail) {
  exchange_->close = unread_ = true;
  const DirectAnswer answer = refusal(*exchange_, code, detail);  // the detail may be the body's detail
  body_.reset();
  answer_directly(answer);
}

void Connection::answer_directly(const DirectAnswer& answer) {
  exchange_->release_body();
  if (context_.draining) exchange_->close = true;
  exchange_->status = answer.reply.status;
  exchange_->problem = answer.reply.problem;
  const std::string text = answer_text(*exchange_, answer);
  send_rest({text.size(), exchange_->send(text)});
}

void Connection::answer() {
  const Sent sent = context_.answer(*exchange_);
  exchange_->release_body();
  send_rest(sent);
}

void Connection::send_rest(const Sent& sent) {
  sent_ = sent;
  write_patience_.emplace(exchange_->unsent->rest());
  begin(Phase::sending, write_patience_->deadline());
}

bool Connection::sending() {
  UnsentAnswers::Answer& unsent = *exchange_->unsent;
  if (sent_.usable && unsent.has_rest()) {
    const auto written = unsent.send_rest();
    sent_.usable = written.has_value() && (*written > 0 || Clock::now() < deadline_);
  }
  if (sent_.usable && unsent.has_rest()) {
    stop_seen_ = context_.stop.raised();
    if (stop_seen_) write_patience_->stop();
    deadline_ = write_patience_->deadline();
    return false;
  }
  end_exchange();
  return true;
}

void Connection::end_exchange() {
  context_.steps.end(*exchange_, sent_.bytes, peer_);
  const bool goes_on = sent_.usable && !exchange_->close;
  exchange_.reset();
  under_way_.reset();
  if (goes_on && body_) {
    begin(Phase::dropping, Clock::now() + context_.settings.read_timeout);
  } else if (goes_on) {
    begin(Phase::idle, Clock::now() + context_.settings.idle_timeout);
  } else if (unread_ || socket_.has_input()) {
    socket_.end_sending();
    begin(Phase::lingering, Clock::now() + kLinger);
  } else {
    phase_ = Phase::over;
  }
}

bool Connection::dropping() {
  const BodyReader::State state = body_->take(input_);
  if (state == BodyReader::State::complete) {
    body_.reset();
    begin(Phase::idle, Clock::now() + context_.settings.idle_timeout);
    return true;
  }
  const Input input = state == BodyReader::State::failed ? Input::end : receive();
  if (input == Input::nothing) return false;
  if (input != Input::some) {
    socket_.end_sending();
    begin(Phase::lingering, Clock::now() + kLinger);
  }
  return true;
}

bool Connection::lingering() {
  input_.clear();
  const Input input = Clock::now() >= deadline_ ? Input::timeout : receive();
  if (input == Input::nothing) return false;
  if (input != Input::some) phase_ = Phase::over;
  return true;
}

}  // namespace fleetplan::server
