#include "server/http/steps/cors.h"

#include <algorithm>
#include <utility>

#include "server/http/guard/authority.h"
#include "server/http/text.h"

namespace fleetplan::server {

namespace {

constexpr std::string_view kAny = "*";
/// Seconds for which a browser caches the answer to a preflight; browsers limit it to two hours.
constexpr const char* kMaxAge = "7200";

bool is_host_char(char c) {
  constexpr std::string_view kMarks = "-._[]:";
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || kMarks.find(c) != std::string_view::npos;
}

/// True when the origin, `scheme://host[:port]`, has the host and port of `requested`.
bool has_authority(std::string_view origin, std::string_view requested) {
  const auto scheme_end = origin.find("://");
  if (scheme_end == std::string_view::npos) return false;
  const auto page = parse_authority(origin.substr(scheme_end + 3));
  const auto service = parse_authority(requested);
  if (!page || !service || page->host != service->host) return false;
  const std::string usual = origin.starts_with("https:") ? "443" : "80";
  const auto port_of = [&](const Authority& of) { return of.port.empty() ? usual : of.port; };
  return port_of(*page) == port_of(*service);
}

}  // namespace

CrossOrigin::CrossOrigin(std::vector<std::string> origins)
    : origins_(std::move(origins)),
      any_(std::find(origins_.begin(), origins_.end(), kAny) != origins_.end()) {}

bool CrossOrigin::allows(std::string_view origin) const {
  return any_ || std::find(origins_.begin(), origins_.end(), origin) != origins_.end();
}

bool CrossOrigin::admits(const RequestHead& head) const {
  if (!head.has_field("origin")) return true;
  const std::string origin = head.field("origin");
  return allows(origin) || has_authority(origin, head.host.value_or(""));
}

HeaderFields CrossOrigin::answer_fields(const RequestHead& head) const {
  if (origins_.empty()) return {};
  HeaderFields fields;
  // Also without an Origin, so that a cache keeps the answers apart.
  if (!any_) fields.emplace_back("Vary", "Origin");
  const std::string origin = head.field("origin");
  if (origin.empty() || !allows(origin)) return fields;
  fields.emplace_back("Access-Control-Allow-Origin", any_ ? std::string(kAny) : origin);
  fields.emplace_back("Access-Control-Expose-Headers", "X-Request-Id, Retry-After, traceparent");
  return fields;
}

bool CrossOrigin::is_preflight(const RequestHead& head) const {
  return head.method == "OPTIONS" && head.has_field("access-control-request-method") &&
         head.has_field("origin") && allows(head.field("origin"));
}

HeaderFields CrossOrigin::preflight_fields(std::string_view methods) {
  return {{"Access-Control-Allow-Methods", std::string(methods)},
          {"Access-Control-Allow-Headers",
           "Accept, Authorization, Content-Encoding, Content-Type, X-Request-Id, traceparent, tracestate"},
          {"Access-Control-Max-Age", kMaxAge}};
}

std::optional<std::string> origin_fault(std::string_view origin) {
  if (origin == kAny) return std::nullopt;
  const auto scheme_end = origin.find("://");
  if (scheme_end != std::string_view::npos && scheme_end > 0) {
    const auto scheme = origin.substr(0, scheme_end);
    const auto host = origin.substr(scheme_end + 3);
    const bool plain_scheme =
        std::all_of(scheme.begin(), scheme.end(), [](char c) { return c >= 'a' && c <= 'z'; });
    if (plain_scheme && !host.empty() && std::all_of(host.begin(), host.end(), is_host_char)) {
      return std::nullopt;
    }
  }
  return in_quotes(origin) +
         " is not an origin such as https://fleet.example:8443 (lower case, no path), nor *";
}

}  // namespace fleetplan::server
