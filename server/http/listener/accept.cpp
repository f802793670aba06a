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
  const int fd = ::accept4(listening_fd, nullptr, nullptr, SOCK_CLOEXEC);
  const int yes = 1;
  if (fd >= 0) ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return fd;
}

}  // namespace fleetplan::server
