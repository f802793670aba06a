#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace fleetplan::server {

/// Lines on their way to a descriptor, written by a thread of its own, so that a reader who does not read
/// delays nobody: lines beyond `max_bytes` are dropped and counted. Thread-safe.
class LogQueue {
 public:
  LogQueue(int fd, std::size_t max_bytes);

  /// Flushes. If the reader does not read, the thread stays behind, waiting for it.
  ~LogQueue();
  LogQueue(const LogQueue&) = delete;
  LogQueue& operator=(const LogQueue&) = delete;

  /// Takes a line with its end, or drops it. Never waits for the reader.
  void push(std::string line);

  /// Waits until all lines have been written, but no longer than this.
  void flush(std::chrono::milliseconds patience = std::chrono::milliseconds(1000)) const;

  /// Lines that were not written: the queue was full, or the descriptor did not take them.
  std::uint64_t dropped() const;

 private:
  struct State;

  std::shared_ptr<State> state_;  // also of the thread, which may outlive this
};

}  // namespace fleetplan::server
