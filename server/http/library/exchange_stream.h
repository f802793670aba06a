#pragma once

#include <cstdint>
#include <string>

#include "server/http/exchange.h"
#include "server/http/library/http_library.h"

namespace fleetplan::server {

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

  /// Sends what is held back; false when the client is gone.
  bool flush();

  std::uint64_t written() const { return exchange_.streamed.value_or(written_); }

 private:
  Exchange& exchange_;
  std::string input_;
  std::size_t position_ = 0;
  std::string held_;  // the head of the answer waits for its body: one packet instead of two
  std::uint64_t written_ = 0;
};

}  // namespace fleetplan::server
