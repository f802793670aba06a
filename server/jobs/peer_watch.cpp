#include "server/jobs/peer_watch.h"

#include <utility>

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

}  // namespace fleetplan::server
