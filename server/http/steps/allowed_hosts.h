#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/guard/request_head.h"

namespace fleetplan::server {

/// The names by which requests may address a service that listens on loopback. A page on the web can have the
/// name of its own server resolved to 127.0.0.1 ("DNS rebinding"); the browser then treats this service as
/// the page's own server, but the Host field still has the page's name.
class AllowedHosts {
 public:
  /// `listening`: the address of the service; only if it is a local name, requests are restricted. `names`:
  /// those that are allowed besides local names, without port; `*` for any.
  AllowedHosts(std::string_view listening, const std::vector<std::string>& names);

  /// Also true for a request without Host (HTTP/1.0), which no browser sends.
  bool admits(const RequestHead& head) const;

 private:
  bool any_;
  std::vector<std::string> names_;  // in lower case
};

/// Why AllowedHosts does not accept this name; none when it does.
std::optional<std::string> host_name_fault(std::string_view name);

}  // namespace fleetplan::server
