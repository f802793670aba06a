#include "server/http/exchange_stream.h"

#include <algorithm>
#include <string_view>

#include "server/http/negotiation.h"

namespace fleetplan::server {

namespace {

constexpr std::size_t kHoldBytes = 64 * 1024;

/// The request as the library is to see it. A body that is not coded stays in the exchange.
std::string shown_request(const Exchange& exchange) {
  const RequestHead& head = exchange.head;
  std::string shown = head.method + " / HTTP/1.1\r\n";
  if (accepts_gzip(head.field("accept-encoding"))) shown += "Accept-Encoding: gzip\r\n";
  const bool coded = content_coding(head.field("content-encoding")) == ContentCoding::gzip;
  if (head.method != "POST") return shown + "\r\n";
  if (!coded) return shown + "Content-Length: 0\r\n\r\n";
  shown += "Content-Encoding: gzip\r\nContent-Length: " + std::to_string(exchange.body.size()) + "\r\n\r\n";
  return shown + exchange.body;
}

}  // namespace

ExchangeStream::ExchangeStream(Exchange& exchange) : exchange_(exchange), input_(shown_request(exchange)) {}

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
  } else if (!flush() || !exchange_.socket->write_all({data, size})) {
    return -1;
  }
  return static_cast<ssize_t>(size);
}

bool ExchangeStream::flush() {
  if (exchange_.abandoned) return false;
  const std::string held = std::move(held_);
  held_.clear();
  return exchange_.socket->write_all(held);
}

// The library wants addresses for header fields which nobody reads here.
void ExchangeStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}
void ExchangeStream::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace fleetplan::server
