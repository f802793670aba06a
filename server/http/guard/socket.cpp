#include "server/http/guard/socket.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace fleetplan::server {

namespace {

constexpr std::chrono::seconds kWriteTimeout{10};
constexpr std::size_t kLeastBytesPerMs = 10;
constexpr std::chrono::seconds kWriteTimeoutAtTheEnd{2};
constexpr std::chrono::seconds kLinger{3};

int milliseconds_until(Socket::Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Socket::Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
}

}  // namespace

Socket::~Socket() { ::close(fd_); }

Socket::Read Socket::read_some(std::string& into, Clock::time_point deadline) {
  std::array<char, 16 * 1024> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by recv
  while (true) {
    const ssize_t got = ::recv(fd_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (got > 0) {
      into.append(buffer.data(), static_cast<std::size_t>(got));
      return Read::some;
    }
    if (got == 0) return Read::end;
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return Read::end;
    std::array<pollfd, 2> wanted{{{fd_, POLLIN, 0}, {stop_fd_, POLLIN, 0}}};
    const int ready = ::poll(wanted.data(), wanted.size(), milliseconds_until(deadline));
    if (ready == 0) return Read::timeout;
    if (wanted[1].revents != 0) return Read::stopped;
  }
}

bool Socket::write_all(std::string_view data) {
  auto deadline = Clock::now() + kWriteTimeout + std::chrono::milliseconds(data.size() / kLeastBytesPerMs);
  bool stopped = false;
  while (!data.empty()) {
    const ssize_t sent = ::send(fd_, data.data(), data.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) {
      data.remove_prefix(static_cast<std::size_t>(sent));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return false;
    std::array<pollfd, 2> wanted{{{fd_, POLLOUT, 0}, {stop_fd_, POLLIN, 0}}};
    const auto patience = std::min(deadline, Clock::now() + kWriteTimeout);
    if (::poll(wanted.data(), stopped ? 1 : 2, milliseconds_until(patience)) == 0) return false;
    if (!stopped && wanted[1].revents != 0) {
      stopped = true;
      deadline = std::min(deadline, Clock::now() + kWriteTimeoutAtTheEnd);
    }
  }
  return true;
}

bool Socket::has_input() const {
  char ignored = 0;
  return ::recv(fd_, &ignored, 1, MSG_DONTWAIT | MSG_PEEK) > 0;
}

bool Socket::peer_gone() const {
  pollfd hangup{fd_, POLLRDHUP, 0};
  return ::poll(&hangup, 1, 0) > 0;
}

void Socket::hang_up() { ::shutdown(fd_, SHUT_RDWR); }

std::string Socket::peer() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  if (::getpeername(fd_, generic, &size) != 0 ||
      ::getnameinfo(generic, size, host.data(), host.size(), port.data(), port.size(),
                    NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return {};
  }
  const std::string name = host.data();
  return (address.ss_family == AF_INET6 ? '[' + name + ']' : name) + ':' + port.data();
}

void Socket::linger() {
  ::shutdown(fd_, SHUT_WR);
  const auto deadline = Clock::now() + kLinger;
  std::string ignored;
  while (Clock::now() < deadline && read_some(ignored, deadline) == Read::some) ignored.clear();
}

}  // namespace fleetplan::server
