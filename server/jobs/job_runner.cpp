#include "server/jobs/job_runner.h"

#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "api/response/error.h"
#include "server/http/answer/internal_error.h"

namespace fleetplan::server {

namespace {

/// While jobs are short, this multiple of the queue is accepted in addition.
constexpr std::size_t kBurst = 7;

}  // namespace

JobRunner::JobRunner(const Settings& settings, const RequestLog& log)
    : limits_(settings.limits),
      log_(log),
      workers_(settings.workers, settings.queue, kBurst * settings.queue) {}

api::Reply JobRunner::run(Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events) {
  auto job = workers_.admit();
  if (!job) {
    exchange.retry_after_s = workers_.retry_after_s();
    return api::problem_reply(api::ErrorCode::overloaded,
                              "All workers are busy and the queue is full: try again later.",
                              exchange.request_id);
  }
  api::Reply reply = compute(exchange, endpoint, events, *job);
  if (reply.leftovers) disposal_.take(std::move(reply.leftovers));
  return reply;
}

api::Reply JobRunner::compute(Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events,
                              Workers::Job& job) {
  std::stop_source stop;
  const std::stop_callback cancel(cancel_all_.get_token(), [&stop] { stop.request_stop(); });
  const PeerWatch::Watched watched(peers_, *exchange.socket, stop);

  api::RequestContext context;
  context.request_id = exchange.request_id;
  context.received_at = exchange.received_at;
  context.stop = stop.get_token();
  context.limits = limits_;
  context.executor = &workers_;
  context.events = events;
  context.await_turn = [&](const core::StopCondition& patience) {
    const auto since = Workers::Clock::now();
    job.await_turn(patience);
    exchange.queue_ms = std::chrono::duration<double, std::milli>(Workers::Clock::now() - since).count();
  };
  api::Reply reply = reply_of(endpoint, exchange, context);
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
