#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/guard/request_head.h"

namespace fleetplan::server {

/// Which pages of other origins a browser lets read answers (the Fetch standard's CORS protocol). No
/// credentials of the browser: a page shows the token itself.
class CrossOrigin {
 public:
  /// `origins`: each `scheme://host[:port]`, or `*` for any; none at all: nobody.
  explicit CrossOrigin(std::vector<std::string> origins);

  /// Header fields of every answer to this request.
  HeaderFields answer_fields(const RequestHead& head) const;

  /// True when a browser asks, on behalf of a page that is allowed, before it sends the request proper.
  bool is_preflight(const RequestHead& head) const;

  /// Further fields of the answer to that; `methods`: those of the resource.
  static HeaderFields preflight_fields(std::string_view methods);

 private:
  bool allows(std::string_view origin) const;

  std::vector<std::string> origins_;
  bool any_;
};

/// Why this is no origin as CrossOrigin wants it; none when it is.
std::optional<std::string> origin_fault(std::string_view origin);

}  // namespace fleetplan::server
