#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>

#include "server/connections/connection.h"

namespace fleetplan::server {

/// The threads of requests: one thread for every request that is being read or answered. Beyond a limit,
/// requests wait. Threads are started on demand and end when they have been idle for a while.
class RequestThreads {
 public:
  explicit RequestThreads(std::size_t max_threads) : max_threads_(max_threads) {}
  ~RequestThreads();
  RequestThreads(const RequestThreads&) = delete;
  RequestThreads& operator=(const RequestThreads&) = delete;

  /// Adds a task. Throws when not even one thread can be started.
  void push(std::function<void()> task);

  /// Runs all tasks that were added and ends all threads.
  void shutdown();

 private:
  using Threads = std::list<std::thread>;

  void work(Threads::iterator self);
  void reap();

  const std::size_t max_threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  Threads threads_;
  Threads ended_;  // left their loop, to be joined
  std::size_t idle_ = 0;
  bool stopping_ = false;
};

/// What a failed accept() means for the listener.
enum class AcceptFault {
  none_waiting,     // there is no connection to accept
  connection_lost,  // this connection is gone; the next one may be fine
  exhausted,        // no descriptors or no memory for now
  broken,           // the listening socket is not one, or no longer
};

/// Returns what the error number of accept() means (accept(2)).
AcceptFault accept_fault(int error);

/// Accepts a connection on a listening socket that does not block. Returns its descriptor, which is closed on
/// exec and sends small answers at once. Returns -1 with errno set if it fails.
int accept_connection(int listening_fd);

/// Accepts the connections of a port. Keeps the connections that wait for their clients, with one thread for
/// all of them (epoll). A connection that can go on gets a thread until it has to wait again.
class Listener {
 public:
  struct Context {
    std::size_t threads;      // requests that are read or answered at a time
    std::size_t connections;  // open at a time; beyond, the connection that has waited for its client longest
                              // is closed
    const StopSignal& stop;   // once raised, connections do not wait for input any more
    std::function<std::unique_ptr<Connection>(int fd)> connect;  // takes the descriptor over
    std::function<void(const std::string& what)> report;         // a fault of one connection
    std::function<void(const std::string& why)> failed;          // no more connections are accepted
    std::function<int(int listening_fd)> accept = accept_connection;
  };

  explicit Listener(Context context);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Accepts until stop() and serves until all connections have ended.
  void run(int listening_fd);

  /// Ends run(). Raise the stop signal before. May be called from any thread.
  void stop();

  /// The number of open connections.
  std::size_t connections() const;

 private:
  using Clock = Connection::Clock;
  using Id = std::uint64_t;

  /// A connection. It is `parked` while it waits for its client. Otherwise, a thread has it.
  struct Held {
    std::unique_ptr<Connection> connection;
    std::optional<Connection::Wait> parked = std::nullopt;
  };

  void handle_events(int listening_fd);
  void accept_some(int listening_fd);
  void pause_accepting(int listening_fd);
  void accept_again(int listening_fd);
  void end_accepting(int listening_fd);

  /// Closes the connection that has waited for its client longest. Returns false if none waits.
  bool make_room();
  void add(int fd);

  /// Makes a thread go on with a connection that is not parked.
  void start(Id id, Connection& connection);
  void serve(Id id, Connection& connection);

  /// Parks a connection. Returns false if it must go on first, to see the stop signal.
  bool park(Id id, const Connection::Wait& wait);
  void unpark(Id id, Held& held);
  void resume(Id id);
  void resume_parked(Clock::time_point until);
  void tell_all_of_stop();
  void end(Id id);

  Context context_;
  int epoll_fd_;
  StopSignal wake_;                                               // wakes the listener for stop()
  std::optional<Clock::time_point> paused_until_ = std::nullopt;  // end of a pause in accepting
  RequestThreads threads_;

  mutable std::mutex mutex_;  // guards all below
  bool stop_told_ = false;    // the parked connections have been told of the stop
  Id next_id_;
  std::unordered_map<Id, Held> held_;
  std::set<std::pair<Clock::time_point, Id>> by_deadline_;  // parked connections by deadline
  std::set<std::pair<Clock::time_point, Id>> by_since_;     // parked connections by the begin of their wait
};

}  // namespace fleetplan::server
