#include "server/http/listener.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "server/http/connection_threads.h"

namespace fleetplan::server {

namespace {

constexpr int kListenBacklog = 511;

/// The library's default would add SO_REUSEPORT, with which a second instance silently shares the port.
void set_listening_options(int fd) {
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

void disable_nagle(int fd) {
  const int yes = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

}  // namespace

Listener::Listener(std::string host, int port, std::size_t connections, Serve serve)
    : host_(std::move(host)), port_(port), serve_(std::move(serve)) {
  new_task_queue = [connections] { return new ConnectionThreads(connections); };
  set_socket_options(set_listening_options);
}

Listener::~Listener() {
  if (listening_fd_ >= 0) ::close(listening_fd_);
}

std::optional<std::string> Listener::bind() {
  errno = 0;
  const int wanted = port_;
  if (wanted == 0) {
    port_ = bind_to_any_port(host_);
  } else if (!bind_to_port(host_, wanted)) {
    port_ = -1;
  }
  if (port_ <= 0) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "no such address";
    return "cannot listen on " + host_ + ':' + std::to_string(wanted) + ": " + reason;
  }
  listening_fd_ = svr_sock_.load();
  ::listen(listening_fd_, kListenBacklog);  // again: the library's backlog of 5 refuses bursts
  return std::nullopt;
}

void Listener::run() { listen_after_bind(); }

void Listener::stop() {
  // Shut down, so that accept() returns, but not closed: the number may not serve another socket before run()
  // has ended.
  svr_sock_ = INVALID_SOCKET;
  ::shutdown(listening_fd_, SHUT_RDWR);
}

bool Listener::process_and_close_socket(socket_t fd) {
  disable_nagle(fd);
  serve_(fd);
  return true;
}

}  // namespace fleetplan::server
