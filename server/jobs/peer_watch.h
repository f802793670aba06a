#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "server/http/socket.h"

namespace fleetplan::server {

/// Watches the clients that wait for their answers, with one thread for all of them. When a client leaves,
/// its job receives a stop request. Thread-safe.
class PeerWatch {
 public:
  /// The time within which it is noticed that a client leaves.
  static constexpr std::chrono::milliseconds kPeriod{25};

  class Watched;

  PeerWatch();
  /// No `Watched` may be left when this is destroyed.
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

/// Watches a socket for as long as this lives; the socket has to outlive it.
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

}  // namespace fleetplan::server
