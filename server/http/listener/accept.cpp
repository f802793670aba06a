#include "server/http/listener/accept.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>

namespace fleetplan::server {

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
  /// Bytes that the kernel takes before they are sent: what a client does not read belongs to UnsentAnswers.
  constexpr int kMostUnsent = 128 * 1024;
  const int fd = ::accept4(listening_fd, nullptr, nullptr, SOCK_CLOEXEC);
  const int yes = 1;
  if (fd < 0) return fd;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  ::setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kMostUnsent, sizeof kMostUnsent);
  return fd;
}

}  // namespace fleetplan::server
