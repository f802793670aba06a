#include "server/jobs/job_runner.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "api/json/errors.h"
#include "server/http/request/access.h"
#include "server/http/request/content.h"
#include "server/ops/request_log.h"

namespace fleetplan::server {

PeerWatch::PeerWatch() : thread_([this] { watch(); }) {}

PeerWatch::~PeerWatch() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void PeerWatch::watch() {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      // Short jobs start and end between two checks without waking this thread.
      changed_.wait_for(lock, kPeriod, [&] { return stopping_; });
      // Set anew each time: the job that woke this thread may have ended, and the next has to wake it again.
      changed_.wait(lock, [&] {
        asleep_ = !stopping_ && watched_.empty();
        return !asleep_;
      });
      if (stopping_) return;
    }
    for (std::stop_source& stop : take_leavers()) stop.request_stop();
  }
}

std::vector<std::stop_source> PeerWatch::take_leavers() {
  std::vector<std::stop_source> leavers;
  const std::lock_guard lock(mutex_);
  for (Watched* one : watched_) {
    if (one->gone_ || !one->socket_.peer_gone()) continue;
    one->gone_ = true;
    leavers.push_back(one->stop_);
  }
  return leavers;
}

PeerWatch::Watched::Watched(PeerWatch& watch, const Socket& socket, std::stop_source stop)
    : watch_(watch), socket_(socket), stop_(std::move(stop)) {
  bool wake = false;
  {
    const std::lock_guard lock(watch_.mutex_);
    watch_.watched_.push_back(this);
    wake = std::exchange(watch_.asleep_, false);
  }
  if (wake) watch_.changed_.notify_one();
}

PeerWatch::Watched::~Watched() {
  const std::lock_guard lock(watch_.mutex_);
  std::erase(watch_.watched_, this);
}

bool PeerWatch::Watched::gone() const {
  const std::lock_guard lock(watch_.mutex_);
  return gone_;
}

Disposal::Disposal() : thread_([this] { work(); }) {}

Disposal::~Disposal() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Disposal::take(std::shared_ptr<const void> object) {
  {
    const std::lock_guard lock(mutex_);
    if (!object_ && !busy_) object_.swap(object);
  }
  changed_.notify_one();
}

void Disposal::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || object_; });
    if (!object_) return;
    auto object = std::exchange(object_, nullptr);
    busy_ = true;
    lock.unlock();
    object.reset();
    lock.lock();
    busy_ = false;
  }
}

namespace {

using Clock = Workers::Clock;

/// The multiple of the queue that is accepted in addition while jobs are short.
constexpr std::size_t kBurst = 7;

/// The least time that is left to code an answer, whatever the budget.
constexpr std::chrono::milliseconds kForCoding{50};

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

/// Returns the answer to a request whose body was not parsed.
api::Reply unparsed(const std::string& request_id, bool cancelled) {
  if (!cancelled) return api::too_busy(request_id);
  return api::problem_reply(api::ErrorCode::draining, api::kDrainingDetail, request_id);
}

bool is_gzip(const Exchange& exchange) {
  return content_coding(exchange.head.field("content-encoding")) == ContentCoding::gzip;
}

/// Returns the size of the decoded text that the last gzip member of a body claims to have (RFC 1952, 2.3.1).
std::size_t claimed_size(std::string_view coded) {
  constexpr std::size_t kBytes = 4;
  std::size_t size = 0;
  for (std::size_t i = 0; i < std::min(kBytes, coded.size()); ++i) {
    size = size << 8 | static_cast<unsigned char>(coded[coded.size() - 1 - i]);
  }
  return size;
}

/// Returns the number of bytes to parse, which decides about slots. A coded body counts with the size that it
/// claims, or with the usual size of JSON that is coded, if that is more. A body that may have a PNG does not
/// count as small: the image of a large map has some kilobytes, and takes a second.
std::size_t bytes_to_parse(const Exchange& exchange, const api::Limits& limits) {
  constexpr std::size_t kRatio = 10;
  constexpr std::size_t kNotSmall = ParseSchedule::kSmall + 1;
  const std::size_t size = exchange.body.size();
  if (!is_gzip(exchange)) {
    const bool may_have_png = size < kNotSmall && exchange.body.find("\"png\"") != std::string::npos;
    return may_have_png ? kNotSmall : size;
  }
  const std::size_t claimed = std::max(kRatio * size, claimed_size(exchange.body));
  return std::max(kNotSmall, std::min<std::size_t>(claimed, limits.max_body));
}

/// Decodes the exchange's body if it is coded.
std::optional<BodyFault> decode_body(Exchange& exchange, std::uint64_t limit,
                                     const core::StopCondition& stop) {
  if (!is_gzip(exchange)) return std::nullopt;
  auto decoded = gunzip(exchange.body, limit, *exchange.memory, stop);
  if (auto* fault = std::get_if<BodyFault>(&decoded)) return std::move(*fault);
  exchange.body = std::get<std::string>(std::move(decoded));
  return std::nullopt;
}

/// Codes the answer if the client accepts that. The answer stays plain if it is small, or if `stop` is met
/// before.
void code_answer(Exchange& exchange, api::Reply& reply, const core::StopCondition& stop) {
  constexpr std::size_t kLeast = 256;
  if (reply.body.size() < kLeast || !accepts_gzip(exchange.head.field("accept-encoding"))) return;
  auto coded = gzip(reply.body, stop);
  if (!coded) return;
  reply.body = std::move(*coded);
  exchange.fields.emplace_back("Content-Encoding", "gzip");
}

Schedule::Kind kind_of(api::TurnNeed::Kind kind) {
  switch (kind) {
    case api::TurnNeed::Kind::plan:
      return Schedule::Kind::plan;
    case api::TurnNeed::Kind::simulation:
      return Schedule::Kind::simulation;
    case api::TurnNeed::Kind::conversion:
      return Schedule::Kind::conversion;
    case api::TurnNeed::Kind::travel:
      return Schedule::Kind::travel;
    case api::TurnNeed::Kind::check:
      break;
  }
  return Schedule::Kind::check;
}

/// A job's turn, noted in its exchange. The body is parsed until the turn is requested.
class ExchangeTurn final : public api::Turn {
 public:
  ExchangeTurn(Workers::Job& job, ParseSlots::Slot& slot, Exchange& exchange)
      : job_(job), slot_(slot), exchange_(exchange) {}

  bool request(const api::TurnNeed& need) override {
    slot_.release();
    answer_by_ = need.answer_by;
    stop_ = need.stop;
    since_ = Clock::now();
    return job_.request_turn({kind_of(need.kind), need.stop.deadline(), need.work, need.is_short});
  }

  bool await() override {
    exchange_.had_turn = job_.await_turn(*stop_);
    exchange_.queue_ms = seconds_since(since_) * 1000.0;
    return exchange_.had_turn;
  }

  bool let_others() override { return job_.let_others(*stop_); }

  Clock::time_point answer_by() const { return answer_by_; }

 private:
  Workers::Job& job_;
  ParseSlots::Slot& slot_;
  Exchange& exchange_;
  std::optional<core::StopCondition> stop_;  // set when the turn is requested
  Clock::time_point since_ = Clock::time_point::max();
  Clock::time_point answer_by_ = Clock::time_point::max();
};

}  // namespace

JobRunner::JobRunner(const Settings& settings, const RequestLog& log)
    : limits_(settings.limits),
      trusted_proxies_(settings.trusted_proxies),
      log_(log),
      maps_(settings.map_cache),
      workers_({static_cast<std::size_t>(settings.workers), settings.queue, kBurst * settings.queue}),
      parse_slots_(static_cast<std::size_t>(settings.workers)) {}

api::Reply JobRunner::run(Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events) {
  const std::string client =
      client_of(exchange.socket->peer(), exchange.head.field("x-forwarded-for"), trusted_proxies_);
  Workers::Job job(workers_, client);
  api::Reply reply =
      job.refusal() ? refused(exchange, *job.refusal()) : compute(exchange, endpoint, events, job, client);
  const bool is_overloaded = reply.problem == api::name_of(api::ErrorCode::overloaded);
  if (is_overloaded) exchange.retry_after_s = workers_.retry_after_s();
  if (reply.leftovers) disposal_.take(std::move(reply.leftovers));
  return reply;
}

api::Reply JobRunner::refused(Exchange& exchange, Refusal refusal) {
  return api::problem_reply(
      api::ErrorCode::overloaded,
      refusal == Refusal::share
          ? "All workers are busy and others wait, too: this client has as many places in "
            "the queue as its share. Try again later."
          : "All workers are busy and the queue is full: try again later.",
      exchange.request_id);
}

api::Reply JobRunner::compute(Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events,
                              Workers::Job& job, const std::string& client) {
  std::stop_source stop;
  const std::stop_callback cancel(cancel_all_.get_token(), [&stop] { stop.request_stop(); });
  const PeerWatch::Watched watched(peers_, *exchange.socket, stop);
  const core::StopCondition latest(exchange.received_at + std::chrono::milliseconds(limits_.max_budget_ms),
                                   stop.get_token());
  ParseSlots::Slot slot(parse_slots_, {client, bytes_to_parse(exchange, limits_)}, latest);
  ExchangeTurn turn(job, slot, exchange);

  api::RequestContext context;
  context.request_id = exchange.request_id;
  context.received_at = exchange.received_at;
  context.stop = stop.get_token();
  context.limits = limits_;
  context.executor = &job;
  context.events = events;
  context.turn = &turn;
  context.maps = &maps_;
  api::Reply reply = slot.has_slot() ? reply_of(endpoint, exchange, context, latest)
                                     : unparsed(exchange.request_id, stop.stop_requested());
  if (turn.answer_by() != Clock::time_point::max()) exchange.late_s = seconds_since(turn.answer_by());
  if (events == nullptr) {
    const auto until = std::max(turn.answer_by() - kForCoding, Clock::now()) + kForCoding;
    code_answer(exchange, reply, core::StopCondition(until, stop.get_token()));
  }
  exchange.abandoned = watched.gone();
  if (exchange.abandoned) reply.status = 499;
  return reply;
}

/// Returns the endpoint's reply. An exception ends here, so that a stream of events can end with the problem,
/// too.
api::Reply JobRunner::reply_of(const Service::Endpoint& endpoint, Exchange& exchange,
                               const api::RequestContext& context, const core::StopCondition& latest) const {
  try {
    if (const auto fault = decode_body(exchange, limits_.max_body, latest)) {
      return api::problem_reply(code_of(fault->kind), fault->detail, exchange.request_id);
    }
    return endpoint(exchange.body, context);
  } catch (...) {
    return internal_error(log_, exchange.request_id, std::current_exception());
  }
}

}  // namespace fleetplan::server
