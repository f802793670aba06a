#include "server/http/guard/authority.h"

#include <arpa/inet.h>

#include <algorithm>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

constexpr std::size_t kMaxPortDigits = 5;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_name_char(char c) {
  constexpr std::string_view kMarks = "-._~%!$&'()*+,;=";
  return (c >= 'a' && c <= 'z') || is_digit(c) || kMarks.find(c) != std::string_view::npos;
}

bool is_ipv6(std::string_view text) {
  in6_addr ignored{};
  return ::inet_pton(AF_INET6, std::string(text).c_str(), &ignored) == 1;
}

}  // namespace

std::optional<Authority> parse_authority(std::string_view text) {
  const bool bracketed = text.starts_with('[');
  const auto host_end = std::min(bracketed ? text.find(']') + 1 : text.find(':'), text.size());
  Authority authority{lower_case(text.substr(0, host_end)), ""};
  const std::string& host = authority.host;
  const bool valid = bracketed ? host.ends_with(']') && is_ipv6(host.substr(1, host.size() - 2))
                               : std::all_of(host.begin(), host.end(), is_name_char);
  if (host.empty() || !valid) return std::nullopt;
  if (host_end == text.size()) return authority;
  authority.port = text.substr(host_end + 1);
  const std::string& port = authority.port;
  if (text[host_end] != ':' || port.size() > kMaxPortDigits ||
      !std::all_of(port.begin(), port.end(), is_digit)) {
    return std::nullopt;
  }
  return authority;
}

bool is_local_name(std::string_view host) {
  if (lower_case(host) == "localhost") return true;
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string text(host);
  in_addr v4{};
  if (::inet_pton(AF_INET, text.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == IN_LOOPBACKNET;
  in6_addr v6{};
  return ::inet_pton(AF_INET6, text.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

}  // namespace fleetplan::server
