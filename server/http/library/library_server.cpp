#include "server/http/library/library_server.h"

#include <fcntl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include "api/json/error.h"
#include "server/http/answer/answer_text.h"
#include "server/http/answer/internal_error.h"
#include "server/http/library/exchange_stream.h"

namespace fleetplan::server {

namespace {

constexpr int kListenBacklog = 511;

/// The library's default would add SO_REUSEPORT, with which a second instance silently shares the port.
void set_listening_options(int fd) {
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

}  // namespace

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): see the header
thread_local Exchange* LibraryServer::current_ = nullptr;

LibraryServer::LibraryServer(Context context) : context_(std::move(context)) {
  set_socket_options(set_listening_options);
  for (const Route& route : context_.routes.routes()) add(route);
  set_exception_handler([this](const httplib::Request& /*request*/, httplib::Response& response,
                               const std::exception_ptr& failure) {
    reply_with(internal_error(context_.log, current_->request_id, failure), response);
  });
  set_post_routing_handler(
      [this](const httplib::Request& /*request*/, httplib::Response& response) { complete(response); });
}

LibraryServer::~LibraryServer() {
  if (listening_fd_ >= 0) ::close(listening_fd_);
}

void LibraryServer::add(const Route& route) {
  const auto handler = [this, &route](const httplib::Request& /*request*/, httplib::Response& response) {
    reply_with(route.handler(*current_), response);
  };
  if (route.takes_body()) {
    Post(route.pattern(), handler);
  } else {
    Get(route.pattern(), handler);
  }
}

void LibraryServer::reply_with(api::Reply reply, httplib::Response& response) const {
  current_->problem = reply.problem;
  current_->outcome = reply.outcome;
  response.status = current_->streamed ? 200 : reply.status;
  if (current_->streamed) return;  // the answer has gone out already
  response.body = std::move(reply.body);
  if (!reply.content_type.empty()) response.set_header("Content-Type", reply.content_type);
}

void LibraryServer::complete(httplib::Response& response) const {
  Exchange& exchange = *current_;
  exchange.status = response.status;
  if (context_.draining) exchange.close = true;
  for (const char* name : {"Keep-Alive", "Accept-Ranges", "Connection"}) response.headers.erase(name);
  response.set_header("Vary", exchange.route->traits.events ? "Accept, Accept-Encoding" : "Accept-Encoding");
  if (response.status == 304) response.headers.erase("Content-Length");
  for (const auto& [name, value] : common_fields(exchange)) response.set_header(name, value);
}

std::optional<std::string> LibraryServer::bind() {
  errno = 0;
  const int wanted = context_.port;
  if (wanted == 0) {
    context_.port = bind_to_any_port(context_.host);
  } else if (!bind_to_port(context_.host, wanted)) {
    context_.port = -1;
  }
  if (context_.port <= 0) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "no such address";
    return "cannot listen on " + context_.host + ':' + std::to_string(wanted) + ": " + reason;
  }
  listening_fd_ = svr_sock_;
  ::listen(listening_fd_, kListenBacklog);  // again: the library's backlog of 5 refuses bursts
  ::fcntl(listening_fd_, F_SETFL, O_NONBLOCK);
  return std::nullopt;
}

Sent LibraryServer::answer(Exchange& exchange) {
  ExchangeStream stream(exchange);
  bool closed = false;  // decided by the exchange, not by the library
  const auto process = [&](auto& library) {
    // Later versions take the addresses of both ends, too; no handler reads them.
    if constexpr (requires { library.process_request(stream, false, closed, nullptr); }) {
      return library.process_request(stream, false, closed, nullptr);
    } else {
      return library.process_request(stream, "", 0, "", 0, false, closed, nullptr);
    }
  };
  current_ = &exchange;
  const bool written = process(*this);
  current_ = nullptr;
  const bool flushed = stream.flush();
  return {stream.written(), written && flushed};
}

}  // namespace fleetplan::server
