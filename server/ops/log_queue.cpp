#include "server/ops/log_queue.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

namespace fleetplan::server {

namespace {

/// False when the descriptor takes no more.
bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written > 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {  // another process has made it non-blocking
      pollfd wanted{fd, POLLOUT, 0};
      ::poll(&wanted, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

std::uint64_t lines_in(std::string_view text) {
  return static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

struct LogQueue::State {
  State(int to, std::size_t most_bytes) : fd(to), max_bytes(most_bytes) {}

  /// Until the queue ends.
  void write() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [this] { return ending || !waiting.empty(); });
      if (waiting.empty()) return;
      const std::string text = std::exchange(waiting, {});
      writing = true;
      lock.unlock();
      const bool written = write_all(fd, text);
      lock.lock();
      writing = false;
      if (!written) dropped += lines_in(text);
      changed.notify_all();
    }
  }

  const int fd;
  const std::size_t max_bytes;
  std::mutex mutex;  // guards all below
  std::condition_variable changed;
  std::string waiting;  // lines
  std::uint64_t dropped = 0;
  bool writing = false;
  bool ending = false;
};

LogQueue::LogQueue(int fd, std::size_t max_bytes) : state_(std::make_shared<State>(fd, max_bytes)) {
  std::thread([state = state_] { state->write(); }).detach();
}

LogQueue::~LogQueue() {
  flush();
  const std::lock_guard lock(state_->mutex);
  state_->ending = true;
  state_->changed.notify_all();
}

void LogQueue::push(std::string line) {
  const std::lock_guard lock(state_->mutex);
  if (state_->waiting.size() + line.size() > state_->max_bytes) {
    ++state_->dropped;
    return;
  }
  if (state_->waiting.empty()) {
    state_->waiting = std::move(line);
  } else {
    state_->waiting += line;
  }
  if (!state_->writing) state_->changed.notify_all();
}

void LogQueue::flush(std::chrono::milliseconds patience) const {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait_for(lock, patience, [this] { return state_->waiting.empty() && !state_->writing; });
}

std::uint64_t LogQueue::dropped() const {
  const std::lock_guard lock(state_->mutex);
  return state_->dropped;
}

}  // namespace fleetplan::server
