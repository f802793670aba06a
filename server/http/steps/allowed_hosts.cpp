#include "server/http/steps/allowed_hosts.h"

#include <algorithm>

#include "server/http/guard/authority.h"
#include "server/http/text.h"

namespace fleetplan::server {

namespace {

constexpr std::string_view kAnyHost = "*";

}  // namespace

AllowedHosts::AllowedHosts(std::string_view listening, const std::vector<std::string>& names)
    : any_(!is_local_name(listening) || std::find(names.begin(), names.end(), kAnyHost) != names.end()) {
  for (const std::string& name : names) names_.push_back(lower_case(name));
}

bool AllowedHosts::admits(const RequestHead& head) const {
  if (any_ || !head.host) return true;
  const auto authority = parse_authority(*head.host);
  if (!authority) return false;
  return is_local_name(authority->host) ||
         std::find(names_.begin(), names_.end(), authority->host) != names_.end();
}

std::optional<std::string> host_name_fault(std::string_view name) {
  if (name == kAnyHost) return std::nullopt;
  const auto authority = parse_authority(name);
  if (authority && authority->port.empty() && !name.ends_with(':')) return std::nullopt;
  return in_quotes(name) + " is not the name of a host such as fleet.example (without port), nor *";
}

}  // namespace fleetplan::server
