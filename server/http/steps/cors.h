#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/guard/request_head.h"

namespace fleetplan::server {

/// The pages of other origins that may use the service and read answers in a browser (the Fetch standard's
/// CORS protocol). Without credentials of the browser: a page sends the token itself.
class CrossOrigin {
 public:
  /// `origins`: each `scheme://host[:port]`, or `*` for any. Empty: no page of another origin.
  explicit CrossOrigin(std::vector<std::string> origins);

  /// Header fields of every answer to this request.
  HeaderFields answer_fields(const RequestHead& head) const;

  /// True when the request is not one of a page of another origin, or that page is allowed. A page whose
  /// origin has the host and port of the request is the service's own: with a proxy that terminates TLS, the
  /// schemes differ.
  bool admits(const RequestHead& head) const;

  /// True for the preflight that a browser sends before the request of a page that is allowed.
  bool is_preflight(const RequestHead& head) const;

  /// Header fields of the answer to a preflight; `methods`: those of the resource.
  static HeaderFields preflight_fields(std::string_view methods);

 private:
  bool allows(std::string_view origin) const;

  std::vector<std::string> origins_;
  bool any_;
};

/// Why CrossOrigin does not accept this origin; none when it does.
std::optional<std::string> origin_fault(std::string_view origin);

}  // namespace fleetplan::server
