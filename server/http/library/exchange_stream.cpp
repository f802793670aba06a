#include "server/http/library/exchange_stream.h"

#include <algorithm>
#include <string_view>

#include "server/http/steps/negotiation.h"

namespace fleetplan::server {

namespace {

constexpr std::size_t kHoldBytes = 64 * 1024;

/// `path` with all but letters, digits, slashes and a few marks as %XX, which the library decodes again.
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

}  // namespace

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

// The library puts the addresses into header fields of the request, which no handler reads.
void ExchangeStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}
void ExchangeStream::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace fleetplan::server
