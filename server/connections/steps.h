#pragma once

// What happens around every handler. In order:
//
//   1. request id      and the trace, taken over from the client if they are well formed
//   2. CORS            header fields for pages of other origins
//   3. route           found by path
//   4. host            421                  of a service on loopback, under a foreign name
//   5. preflight       204                  answered without a token: browsers send none
//   6. origin          403                  of requests with a body, from pages of other origins
//   7. authentication  401
//   8. path            404
//   9. method          405
//  10. content         415, 406, 413        of requests with a body
//  11. draining        503                  of requests with a body
//      the body is read, the handler answers
//  12. metrics
//  13. log
//
// Steps 4 to 11 need no more than the head, so a refused request costs nothing for its body.

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "server/http/answer/direct_answers.h"
#include "server/http/exchange.h"
#include "server/http/request/access.h"
#include "server/ops/metrics.h"
#include "server/ops/request_log.h"
#include "server/ops/settings.h"

namespace fleetplan::server {

/// The steps of one port. Everything it refers to must outlive it. Thread-safe.
class Steps {
 public:
  enum class Port { main, admin };

  Steps(Port port, const Settings& settings, const RouteTable& routes, const CrossOrigin& cross_origin,
        const std::atomic<bool>& draining, Metrics& metrics, const RequestLog& log);

  /// Makes steps 1 to 3, once the head has been read.
  void begin(Exchange& exchange) const;

  /// Makes steps 4 to 11. Returns an answer that needs no handler; none if the request may go on.
  std::optional<DirectAnswer> answer_to_head(const Exchange& exchange) const;

  /// Makes steps 12 and 13, once the answer of `bytes_out` bytes has been sent. `peer`: see Socket::peer.
  void end(Exchange& exchange, std::uint64_t bytes_out, const std::string& peer) const;

 private:
  using Answer = std::optional<DirectAnswer>;

  Answer host(const Exchange& exchange) const;
  Answer preflight(const Exchange& exchange) const;
  Answer origin(const Exchange& exchange) const;
  Answer authentication(const Exchange& exchange) const;
  Answer path(const Exchange& exchange) const;
  Answer method(const Exchange& exchange) const;
  Answer content(const Exchange& exchange) const;
  Answer draining(const Exchange& exchange) const;

  const Port port_;
  const Settings& settings_;
  const RouteTable& routes_;
  const AllowedHosts allowed_hosts_;
  const CrossOrigin& cross_origin_;
  const std::atomic<bool>& draining_;
  Metrics& metrics_;
  const RequestLog& log_;
};

}  // namespace fleetplan::server
