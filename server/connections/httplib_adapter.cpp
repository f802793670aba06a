#include "server/connections/httplib_adapter.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <string_view>
#include <utility>

#include "server/http/answer/direct_answers.h"
#include "server/http/cpp_httplib.h"
#include "server/http/request/content.h"
#include "server/http/route_table.h"

namespace fleetplan::server {

namespace {

constexpr std::size_t kHoldBytes = 64 * 1024;
constexpr int kListenBacklog = 511;

/// The connection as cpp-httplib sees it: a fixed request, because the real request has already been read,
/// and a way to write the answer. Data that the client does not accept at once goes to Exchange::unsent. If
/// the answer has gone out as an EventStream, data that cpp-httplib writes is discarded.
class ExchangeStream final : public httplib::Stream {
 public:
  explicit ExchangeStream(Exchange& exchange) : exchange_(exchange) {}

  bool is_readable() const override { return !input_.empty(); }
  bool is_writable() const override { return !exchange_.abandoned; }
  ssize_t read(char* into, size_t size) override;
  ssize_t write(const char* data, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return exchange_.socket->fd(); }

  /// Sends what is held back. Returns false when the client is gone.
  bool flush();

  std::uint64_t written() const { return exchange_.streamed.value_or(written_); }

 private:
  Exchange& exchange_;
  std::string_view input_ = "GET / HTTP/1.1\r\n\r\n";
  std::string held_;  // the head of the answer waits for its body: one packet instead of two
  std::uint64_t written_ = 0;
};

ssize_t ExchangeStream::read(char* into, size_t size) {
  const std::size_t part = input_.copy(into, size);
  input_.remove_prefix(part);
  return static_cast<ssize_t>(part);
}

ssize_t ExchangeStream::write(const char* data, size_t size) {
  if (exchange_.streamed) return static_cast<ssize_t>(size);
  if (exchange_.abandoned) return -1;
  written_ += size;
  if (held_.size() + size <= kHoldBytes) {
    held_.append(data, size);
  } else if (!flush() || !exchange_.send({data, size})) {
    return -1;
  }
  return static_cast<ssize_t>(size);
}

bool ExchangeStream::flush() {
  if (exchange_.abandoned) return false;
  const std::string held = std::move(held_);
  held_.clear();
  return exchange_.send(held);
}

// Returns no addresses: cpp-httplib puts them into header fields of the request, which no handler reads.
void ExchangeStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}
void ExchangeStream::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

/// The server of cpp-httplib, with the members that its versions keep protected.
class HttplibServer final : public httplib::Server {
 public:
  int socket() const { return svr_sock_; }

  /// Has the request of the stream answered. `set_up` may change it before it is routed. Returns false when
  /// the answer could not be written.
  bool process(httplib::Stream& stream, const std::function<void(httplib::Request&)>& set_up) {
    bool closed = false;  // decided by the exchange, not by cpp-httplib
    const auto process = [&](auto& server) {
      // Later versions take the addresses of both ends, too; no handler reads them.
      if constexpr (requires { server.process_request(stream, false, closed, set_up); }) {
        return server.process_request(stream, false, closed, set_up);
      } else {
        return server.process_request(stream, "", 0, "", 0, false, closed, set_up);
      }
    };
    return process(*this);
  }
};

/// Passes to cpp-httplib what it has to act upon: the method, as HEAD has no body, and whether it may
/// compress the answer. Jobs code their answers. There is no Range that would cut the answer, and no brotli.
void set_up(httplib::Request& request, const Exchange& exchange) {
  request.method = exchange.head.method;
  if (!exchange.route->takes_body() && accepts_gzip(exchange.head.field("accept-encoding"))) {
    request.set_header("Accept-Encoding", "gzip");
  }
}

void reply_with(api::Reply reply, Exchange& exchange, httplib::Response& response) {
  exchange.problem = reply.problem;
  exchange.outcome = reply.outcome;
  response.status = exchange.streamed ? 200 : reply.status;
  if (exchange.streamed) return;  // the answer has gone out already
  response.body = std::move(reply.body);
  if (!reply.content_type.empty()) response.set_header("Content-Type", reply.content_type);
}

/// Completes the head of the answer.
void complete(httplib::Response& response, Exchange& exchange, bool draining) {
  exchange.status = response.status;
  if (draining) exchange.close = true;
  for (const char* name : {"Keep-Alive", "Accept-Ranges", "Connection"}) response.headers.erase(name);
  response.set_header("Vary", exchange.route->traits.events ? "Accept, Accept-Encoding" : "Accept-Encoding");
  if (response.status == 304) response.headers.erase("Content-Length");
  for (const auto& [name, value] : common_fields(exchange)) response.set_header(name, value);
}

/// Sets options of the listening socket. The default of cpp-httplib would add SO_REUSEPORT, with which a
/// second instance silently shares the port.
void set_listening_options(int fd) {
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

}  // namespace

HttplibAdapter::HttplibAdapter(Context context) : context_(std::move(context)) {}

HttplibAdapter::~HttplibAdapter() {
  if (listening_fd_ >= 0) ::close(listening_fd_);
}

std::optional<std::string> HttplibAdapter::bind() {
  HttplibServer server;
  server.set_socket_options(set_listening_options);
  errno = 0;
  const int wanted = context_.port;
  if (wanted == 0) {
    context_.port = server.bind_to_any_port(context_.host);
  } else if (!server.bind_to_port(context_.host, wanted)) {
    context_.port = -1;
  }
  if (context_.port <= 0) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "no such address";
    return "cannot listen on " + context_.host + ':' + std::to_string(wanted) + ": " + reason;
  }
  listening_fd_ = server.socket();
  ::listen(listening_fd_, kListenBacklog);  // repeated, as cpp-httplib's backlog of 5 refuses bursts
  ::fcntl(listening_fd_, F_SETFL, O_NONBLOCK);
  return std::nullopt;
}

Sent HttplibAdapter::answer(Exchange& exchange) const {
  using httplib::Request;
  using httplib::Response;
  // A server for each answer, without routes: cpp-httplib passes its handlers nothing of ours, but they can
  // refer to this exchange. Making it takes one or two microseconds.
  HttplibServer server;
  server.set_pre_routing_handler([&exchange](const Request& /*request*/, Response& response) {
    reply_with(exchange.route->handler(exchange), exchange, response);
    return httplib::Server::HandlerResponse::Handled;
  });
  server.set_exception_handler(
      [&](const Request& /*request*/, Response& response, const std::exception_ptr& failure) {
        reply_with(internal_error(context_.log, exchange.request_id, failure), exchange, response);
      });
  server.set_post_routing_handler([&](const Request& /*request*/, Response& response) {
    complete(response, exchange, context_.draining);
  });
  ExchangeStream stream(exchange);
  const bool written = server.process(stream, [&](Request& request) { set_up(request, exchange); });
  const bool flushed = stream.flush();
  return {stream.written(), written && flushed};
}

}  // namespace fleetplan::server
