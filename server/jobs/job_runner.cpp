#include "server/jobs/job_runner.h"

#include <chrono>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "api/response/error.h"
#include "server/http/answer/internal_error.h"
#include "server/jobs/client_of.h"

namespace fleetplan::server {

namespace {

using Clock = Workers::Clock;

/// While jobs are short, this multiple of the queue is accepted in addition.
constexpr std::size_t kBurst = 7;

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

/// The answer to a request whose body was not parsed.
api::Reply unparsed(const std::string& request_id, bool cancelled) {
  if (!cancelled) return api::too_busy(request_id);
  return api::problem_reply(api::ErrorCode::draining, api::kDrainingDetail, request_id);
}

Schedule::Kind kind_of(api::TurnNeed::Kind kind) {
  switch (kind) {
    case api::TurnNeed::Kind::plan:
      return Schedule::Kind::plan;
    case api::TurnNeed::Kind::simulation:
      return Schedule::Kind::simulation;
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

  Clock::time_point answer_by() const { return answer_by_; }

 private:
  Workers::Job& job_;
  ParseSlots::Slot& slot_;
  Exchange& exchange_;
  std::optional<core::StopCondition> stop_;  // once the turn is requested
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
  Workers::Job job(
      workers_, client_of(exchange.socket->peer(), exchange.head.field("x-forwarded-for"), trusted_proxies_));
  api::Reply reply =
      job.refusal() ? refused(exchange, *job.refusal()) : compute(exchange, endpoint, events, job);
  if (job.refusal()) exchange.retry_after_s = workers_.retry_after_s();
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
                              Workers::Job& job) {
  std::stop_source stop;
  const std::stop_callback cancel(cancel_all_.get_token(), [&stop] { stop.request_stop(); });
  const PeerWatch::Watched watched(peers_, *exchange.socket, stop);
  const auto longest = std::chrono::milliseconds(limits_.max_budget_ms);
  ParseSlots::Slot slot(parse_slots_, exchange.body.size(),
                        core::StopCondition(exchange.received_at + longest, stop.get_token()));
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
  api::Reply reply = slot.has_slot() ? reply_of(endpoint, exchange, context)
                                     : unparsed(exchange.request_id, stop.stop_requested());
  if (turn.answer_by() != Clock::time_point::max()) exchange.late_s = seconds_since(turn.answer_by());
  exchange.abandoned = watched.gone();
  if (exchange.abandoned) reply.status = 499;
  return reply;
}

/// An exception ends here, so that a stream of events can end with the problem, too.
api::Reply JobRunner::reply_of(const Service::Endpoint& endpoint, const Exchange& exchange,
                               const api::RequestContext& context) const {
  try {
    return endpoint(exchange.body, context);
  } catch (...) {
    return internal_error(log_, exchange.request_id, std::current_exception());
  }
}

}  // namespace fleetplan::server
