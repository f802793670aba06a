#include "server/connections/listener.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

namespace fleetplan::server {

namespace {

constexpr std::chrono::seconds kKeepIdleThread{10};

}  // namespace

RequestThreads::~RequestThreads() { shutdown(); }

void RequestThreads::push(std::function<void()> task) {
  reap();
  const std::lock_guard lock(mutex_);
  tasks_.push_back(std::move(task));
  if (tasks_.size() > idle_ && threads_.size() < max_threads_) {
    // The thread cannot read its own entry before this lock is released.
    const auto self = threads_.emplace(threads_.end());
    try {
      *self = std::thread([this, self] { work(self); });
    } catch (const std::system_error&) {
      threads_.erase(self);  // no more threads are available: the request waits for an existing one
      if (threads_.empty()) throw;
    }
  }
  changed_.notify_one();
}

void RequestThreads::shutdown() {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  changed_.notify_all();
  changed_.wait(lock, [&] { return threads_.empty(); });
  lock.unlock();
  reap();
}

void RequestThreads::reap() {
  Threads ended;
  {
    const std::lock_guard lock(mutex_);
    ended.swap(ended_);
  }
  for (auto& thread : ended) thread.join();
}

void RequestThreads::work(Threads::iterator self) {
  std::unique_lock lock(mutex_);
  while (true) {
    ++idle_;
    const bool woken = changed_.wait_for(lock, kKeepIdleThread, [&] { return stopping_ || !tasks_.empty(); });
    --idle_;
    if (tasks_.empty() && (stopping_ || !woken)) break;
    const auto task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
  ended_.splice(ended_.end(), threads_, self);
  changed_.notify_all();
}

AcceptFault accept_fault(int error) {
  switch (error) {
    case EAGAIN:
      return AcceptFault::none_waiting;
    case EMFILE:
    case ENFILE:
    case ENOBUFS:
    case ENOMEM:
      return AcceptFault::exhausted;
    case EBADF:
    case EFAULT:
    case EINVAL:
    case ENOTSOCK:
      return AcceptFault::broken;
    default:  // Linux also reports network errors of the connection, and there may be others
      return AcceptFault::connection_lost;
  }
}

int accept_connection(int listening_fd) {
  /// The most bytes that the kernel takes before they are sent: what a client does not read belongs to
  /// UnsentAnswers.
  constexpr int kMaxUnsent = 128 * 1024;
  const int fd = ::accept4(listening_fd, nullptr, nullptr, SOCK_CLOEXEC);
  const int yes = 1;
  if (fd < 0) return fd;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  ::setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kMaxUnsent, sizeof kMaxUnsent);
  return fd;
}

namespace {

// The subjects of events of epoll, besides connections, whose ids follow.
constexpr std::uint64_t kListening = 0;
constexpr std::uint64_t kWake = 1;
constexpr std::uint64_t kStop = 2;
constexpr std::uint64_t kFirstId = 3;

constexpr std::size_t kMaxEvents = 256;
constexpr int kMaxAccepted = 64;
/// The time between two looks at deadlines: threads park connections without waking the listener.
constexpr std::chrono::milliseconds kTick{50};
/// The pause after a fault of accept(), so that a fault that stays takes no CPU.
constexpr std::chrono::milliseconds kPause{20};

void watch(int epoll_fd, int operation, int fd, std::uint32_t events, std::uint64_t id) {
  epoll_event event{};
  event.events = events;
  event.data.u64 = id;
  ::epoll_ctl(epoll_fd, operation, fd, &event);
}

}  // namespace

Listener::Listener(Context context)
    : context_(std::move(context)),
      epoll_fd_(::epoll_create1(EPOLL_CLOEXEC)),
      threads_(context_.threads),
      next_id_(kFirstId) {
  if (epoll_fd_ < 0) throw std::system_error(errno, std::generic_category(), "epoll_create1");
}

Listener::~Listener() {
  threads_.shutdown();
  ::close(epoll_fd_);
}

std::size_t Listener::connections() const {
  const std::lock_guard lock(mutex_);
  return held_.size();
}

void Listener::stop() { wake_.raise(); }

void Listener::run(int listening_fd) {
  accept_again(listening_fd);
  watch(epoll_fd_, EPOLL_CTL_ADD, wake_.fd(), EPOLLIN | EPOLLONESHOT, kWake);
  watch(epoll_fd_, EPOLL_CTL_ADD, context_.stop.fd(), EPOLLIN | EPOLLONESHOT, kStop);
  while (!wake_.raised() || connections() > 0) {
    handle_events(listening_fd);
    resume_parked(Clock::now());
    if (paused_until_ && Clock::now() >= *paused_until_) accept_again(listening_fd);
  }
  end_accepting(listening_fd);
  threads_.shutdown();
}

void Listener::handle_events(int listening_fd) {
  const bool has_deadlines = paused_until_ || connections() > 0;
  std::array<epoll_event, kMaxEvents> events{};
  const int count = ::epoll_wait(epoll_fd_, events.data(), static_cast<int>(events.size()),
                                 has_deadlines ? static_cast<int>(kTick.count()) : -1);
  for (int i = 0; i < count; ++i) {
    const std::uint64_t id = events[static_cast<std::size_t>(i)].data.u64;
    if (id == kListening) {
      accept_some(listening_fd);
    } else if (id == kWake) {
      end_accepting(listening_fd);
    } else if (id == kStop) {
      tell_all_of_stop();
    } else {
      resume(id);
    }
  }
}

void Listener::accept_some(int listening_fd) {
  for (int i = 0; i < kMaxAccepted; ++i) {
    if (connections() >= context_.connections && !make_room()) return pause_accepting(listening_fd);
    const int fd = context_.accept(listening_fd);
    if (fd >= 0) {
      add(fd);
      continue;
    }
    const int error = errno;
    switch (accept_fault(error)) {
      case AcceptFault::none_waiting:
        return;
      case AcceptFault::connection_lost:
        return pause_accepting(listening_fd);
      case AcceptFault::exhausted:
        make_room();
        return pause_accepting(listening_fd);
      case AcceptFault::broken:
        end_accepting(listening_fd);
        return context_.failed(std::strerror(error));
    }
  }
}

void Listener::pause_accepting(int listening_fd) {
  watch(epoll_fd_, EPOLL_CTL_DEL, listening_fd, 0, kListening);
  paused_until_ = Clock::now() + kPause;
}

void Listener::accept_again(int listening_fd) {
  paused_until_.reset();
  watch(epoll_fd_, EPOLL_CTL_ADD, listening_fd, EPOLLIN, kListening);
}

void Listener::end_accepting(int listening_fd) {
  paused_until_.reset();
  watch(epoll_fd_, EPOLL_CTL_DEL, listening_fd, 0, kListening);
  ::shutdown(listening_fd, SHUT_RDWR);  // clients are refused from now on
}

bool Listener::make_room() {
  std::unique_ptr<Connection> longest;  // is closed after the lock is released
  const std::lock_guard lock(mutex_);
  if (by_since_.empty()) return false;
  const auto found = held_.find(by_since_.begin()->second);
  unpark(found->first, found->second);
  longest = std::move(found->second.connection);
  held_.erase(found);
  return true;
}

void Listener::add(int fd) {
  std::unique_ptr<Connection> connection;
  try {
    connection = context_.connect(fd);
  } catch (const std::exception& failure) {
    ::close(fd);
    return context_.report(failure.what());
  }
  Connection& added = *connection;
  Id id = 0;
  {
    const std::lock_guard lock(mutex_);
    id = next_id_++;
    held_[id].connection = std::move(connection);
  }
  watch(epoll_fd_, EPOLL_CTL_ADD, fd, 0, id);
  if (!park(id, added.wait())) start(id, added);
}

void Listener::start(Id id, Connection& connection) {
  try {
    threads_.push([this, id, &connection] { serve(id, connection); });
  } catch (const std::exception& failure) {  // there is not even one thread
    context_.report(failure.what());
    end(id);
  }
}

void Listener::serve(Id id, Connection& connection) {
  try {
    while (const auto wait = connection.go_on()) {
      if (park(id, *wait)) return;
    }
  } catch (const std::exception& failure) {  // e.g. no memory for its body: ends this connection only
    context_.report(failure.what());
  }
  end(id);
}

bool Listener::park(Id id, const Connection::Wait& wait) {
  const std::lock_guard lock(mutex_);
  if (stop_told_ && !wait.stopped) return false;
  Held& held = held_[id];
  held.parked = wait;
  by_deadline_.emplace(wait.deadline, id);
  by_since_.emplace(wait.since, id);
  watch(epoll_fd_, EPOLL_CTL_MOD, held.connection->fd(),
        static_cast<std::uint32_t>(wait.for_input ? EPOLLIN : EPOLLOUT) | EPOLLONESHOT, id);
  return true;
}

void Listener::unpark(Id id, Held& held) {
  by_deadline_.erase({held.parked->deadline, id});
  by_since_.erase({held.parked->since, id});
  held.parked.reset();
}

void Listener::resume(Id id) {
  Connection* connection = nullptr;
  {
    const std::lock_guard lock(mutex_);
    const auto found = held_.find(id);
    if (found == held_.end() || !found->second.parked) return;  // it has ended, or goes on already
    unpark(id, found->second);
    connection = found->second.connection.get();
  }
  start(id, *connection);
}

void Listener::resume_parked(Clock::time_point until) {
  std::vector<Id> due;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [deadline, id] : by_deadline_) {
      if (deadline > until) break;
      due.push_back(id);
    }
  }
  for (const Id id : due) resume(id);
}

void Listener::tell_all_of_stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_told_ = true;
  }
  resume_parked(Clock::time_point::max());
}

void Listener::end(Id id) {
  std::unique_ptr<Connection> ended;  // is closed after the lock is released
  const std::lock_guard lock(mutex_);
  const auto found = held_.find(id);
  ended = std::move(found->second.connection);
  held_.erase(found);
  if (wake_.raised() && held_.empty())
    watch(epoll_fd_, EPOLL_CTL_MOD, wake_.fd(), EPOLLIN | EPOLLONESHOT, kWake);
}

}  // namespace fleetplan::server
