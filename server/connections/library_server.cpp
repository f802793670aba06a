
#include "server/connections/library_server.h"

#include <fcntl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "server/http/answer/direct_answers.h"
#include "server/http/exchange.h"
#include "server/http/http_library.h"
#include "server/http/request/content.h"
#include "server/ops/request_log.h"

namespace fleetplan::server {

namespace {

/// The connection as the HTTP library sees it: a request that has been read and judged already, and a way to
/// write the answer.
///
/// The library reads the request's real method and its path, percent-encoded in one way, but no query and
/// only those header fields that it has to act upon: no Range that would cut an answer, no brotli. The body
/// stays in the exchange. What the client does not accept at once goes to Exchange::unsent. When the answer
/// has gone out as an EventStream, what the library writes is discarded.
class ExchangeStream final : public httplib::Stream {
 public:
  explicit ExchangeStream(Exchange& exchange);

  bool is_readable() const override { return position_ < input_.size(); }
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
  std::string input_;
  std::size_t position_ = 0;
  std::string held_;  // the head of the answer waits for its body: one packet instead of two
  std::uint64_t written_ = 0;
};

constexpr std::size_t kHoldBytes = 64 * 1024;

/// Returns `path` with all but letters, digits, slashes and a few marks as %XX, which the library decodes
/// again.
std::string percent_encoded(std::string_view path) {
  constexpr std::string_view kPlain = "/-._~";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string encoded;
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       kPlain.find(c) != std::string_view::npos;
    if (plain) {
      encoded += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    encoded += '%';
    encoded += kDigits[byte >> 4];
    encoded += kDigits[byte & 0xf];
  }
  return encoded;
}

std::string request_for_library(const Exchange& exchange) {
  const RequestHead& head = exchange.head;
  std::string request = head.method + ' ' + percent_encoded(head.path) + " HTTP/1.1\r\n";
  if (exchange.route->takes_body()) return request + "Content-Length: 0\r\n\r\n";  // jobs code their answers
  if (accepts_gzip(head.field("accept-encoding"))) request += "Accept-Encoding: gzip\r\n";
  return request + "\r\n";
}

ExchangeStream::ExchangeStream(Exchange& exchange)
    : exchange_(exchange), input_(request_for_library(exchange)) {}

ssize_t ExchangeStream::read(char* into, size_t size) {
  const std::size_t part = std::min(size, input_.size() - position_);
  std::copy_n(input_.data() + position_, part, into);
  position_ += part;
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

// Returns no addresses: the library puts them into header fields of the request, which no handler reads.
void ExchangeStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}
void ExchangeStream::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

constexpr int kListenBacklog = 511;

/// Sets options of the listening socket. The library's default would add SO_REUSEPORT, with which a second
/// instance silently shares the port.
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
  ::listen(listening_fd_, kListenBacklog);  // repeated, as the library's backlog of 5 refuses bursts
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
