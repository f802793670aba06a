
#include "server/http/socket.h"

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

}  // namespace

Socket::~Socket() { ::close(fd_); }

Socket::Read Socket::read_some(std::string& into) {
  std::array<char, 16 * 1024> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by recv
  while (true) {
    const ssize_t got = ::recv(fd_, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (got > 0) {
      into.append(buffer.data(), static_cast<std::size_t>(got));
      return Read::some;
    }
    if (got == 0) return Read::end;
    if (errno == EINTR) continue;
    return errno == EAGAIN || errno == EWOULDBLOCK ? Read::nothing : Read::end;
  }
}

std::optional<std::size_t> Socket::write_some(std::string_view data) {
  std::size_t written = 0;
  while (written < data.size()) {
    const ssize_t sent =
        ::send(fd_, data.data() + written, data.size() - written, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) {
      written += static_cast<std::size_t>(sent);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      break;
    } else if (errno != EINTR) {
      return std::nullopt;
    }
  }
  return written;
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

void Socket::end_sending() { ::shutdown(fd_, SHUT_WR); }

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

WritePatience::WritePatience(std::size_t size)
    : whole_(Socket::Clock::now() + kWriteTimeout + std::chrono::milliseconds(size / kLeastBytesPerMs)) {}

void WritePatience::stop() {
  if (!stopped_) whole_ = std::min(whole_, Socket::Clock::now() + kWriteTimeoutAtTheEnd);
  stopped_ = true;
}

Socket::Clock::time_point WritePatience::deadline() const {
  return std::min(whole_, Socket::Clock::now() + kWriteTimeout);
}

}  // namespace fleetplan::server
