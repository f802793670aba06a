#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "api/endpoints/request_context.h"
#include "api/response/reply.h"
#include "core/map/static_map.h"
#include "server/http/exchange.h"
#include "server/http/socket.h"
#include "server/jobs/parse_slots.h"
#include "server/jobs/workers.h"
#include "server/ops/request_log.h"
#include "server/ops/settings.h"
#include "server/service/service.h"

namespace fleetplan::server {

/// Watches the clients that wait for their answers, with one thread for all of them. When a client leaves,
/// its job receives a stop request. Thread-safe.
class PeerWatch {
 public:
  /// A client that leaves is noticed within this time.
  static constexpr std::chrono::milliseconds kPeriod{25};

  class Watched;

  PeerWatch();
  /// Every `Watched` must be destroyed before this.
  ~PeerWatch();
  PeerWatch(const PeerWatch&) = delete;
  PeerWatch& operator=(const PeerWatch&) = delete;

 private:
  void watch();
  std::vector<std::stop_source> take_leavers();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Watched*> watched_;
  bool asleep_ = false;  // the thread waits until there is something to watch
  bool stopping_ = false;
  std::thread thread_;
};

/// Watches a socket during its lifetime. The socket must outlive it.
class PeerWatch::Watched {
 public:
  Watched(PeerWatch& watch, const Socket& socket, std::stop_source stop);
  ~Watched();
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

  /// Whether the client has left and the stop has been requested.
  bool gone() const;

 private:
  friend class PeerWatch;

  PeerWatch& watch_;
  const Socket& socket_;
  std::stop_source stop_;
  bool gone_ = false;  // guarded by the watch's mutex
};

/// Frees memory in a separate thread, so that answers need not wait for it. Thread-safe.
class Disposal {
 public:
  Disposal();
  ~Disposal();
  Disposal(const Disposal&) = delete;
  Disposal& operator=(const Disposal&) = delete;

  /// Frees the object soon. If an object is already being freed, frees this one at once in this thread: at
  /// most one may wait.
  void take(std::shared_ptr<const void> object);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const void> object_;  // the object to be freed next
  bool busy_ = false;                   // freeing one
  bool stopping_ = false;
  std::thread thread_;
};

/// Runs jobs: requests that take time, such as a plan or a check. Accepts no more jobs than the queue holds.
/// Stops jobs whose client has left. Thread-safe.
///
/// A job waits twice. First, it waits for a slot, in which its body is decoded and parsed. Then, it waits for
/// its turn, in which its answer is made and coded.
class JobRunner {
 public:
  /// Runs jobs as the settings say. The log must outlive it.
  JobRunner(const Settings& settings, const RequestLog& log);

  /// Returns the endpoint's reply to the exchange's body, computed in this thread when its turn has come.
  /// Stores in the exchange the time in the queue, and whether the client has left. `events`: receives the
  /// progress of a plan, or null.
  api::Reply run(Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events);

  WorkerLoad load() const { return workers_.load(); }
  core::MapCache::Stats maps() const { return maps_.stats(); }

  /// Asks all jobs, now and later, to stop.
  void cancel_all() { cancel_all_.request_stop(); }

 private:
  api::Reply refused(Exchange& exchange, Refusal refusal);
  api::Reply compute(Exchange& exchange, const Service::Endpoint& endpoint, api::PlanEvents* events,
                     Workers::Job& job, const std::string& client);
  api::Reply reply_of(const Service::Endpoint& endpoint, Exchange& exchange,
                      const api::RequestContext& context, const core::StopCondition& latest) const;

  const api::Limits limits_;
  const std::vector<AddressRange> trusted_proxies_;
  const RequestLog& log_;
  core::MapCache maps_;
  std::stop_source cancel_all_;
  PeerWatch peers_;
  Disposal disposal_;
  Workers workers_;
  ParseSlots parse_slots_;
};

}  // namespace fleetplan::server
