#include "server/http/request/access.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "server/http/request/request_head.h"
#include "server/http/text.h"

namespace fleetplan::server {

namespace {

bool is_visible(char c) { return c > 0x20 && c < 0x7f; }

}  // namespace

std::variant<AccessToken, std::string> AccessToken::from_text(std::string_view text) {
  if (text.empty()) return "it is empty";
  if (!std::all_of(text.begin(), text.end(), is_visible)) {
    return "it must contain one token of visible ASCII characters, without spaces";
  }
  return AccessToken(text);
}

std::variant<AccessToken, std::string> AccessToken::from_file(const std::string& path) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path, ignored)) return "it cannot be read";
  std::string text(std::istreambuf_iterator<char>(file), {});
  text.erase(text.find_last_not_of("\r\n") + 1);
  return from_text(text);
}

bool AccessToken::admits(std::string_view authorization) const {
  const auto space = authorization.find(' ');
  if (space == std::string_view::npos) return false;
  const std::string scheme = lower_case(authorization.substr(0, space));
  const auto credentials = trimmed(authorization.substr(space));
  if (scheme == "bearer") return equals(credentials);
  if (scheme != "basic") return false;
  const auto user_and_password = base64_decoded(credentials);
  if (!user_and_password) return false;
  const auto colon = user_and_password->find(':');
  return colon != std::string::npos && equals(std::string_view(*user_and_password).substr(colon + 1));
}

bool AccessToken::equals(std::string_view shown) const {
  // Compares every character, wherever the first difference is.
  unsigned difference = shown.size() == token_.size() ? 0 : 1;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    difference |=
        static_cast<unsigned char>(shown[i]) ^ static_cast<unsigned char>(token_[i % token_.size()]);
  }
  return difference == 0;
}

std::optional<std::string> base64_decoded(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string decoded;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const auto digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    decoded += static_cast<char>(bits >> count & 0xff);
  }
  return decoded;
}

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

namespace {

constexpr std::string_view kAny = "*";
/// The seconds for which a browser caches the answer to a preflight; browsers limit it to two hours.
constexpr const char* kMaxAge = "7200";

bool is_host_char(char c) {
  constexpr std::string_view kMarks = "-._[]:";
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || kMarks.find(c) != std::string_view::npos;
}

/// Whether the origin, `scheme://host[:port]`, has the host and port of `requested`.
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
  // The field is there even for requests without an Origin, so that a cache keeps the answers apart.
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

namespace {

constexpr unsigned kBits = 128;
constexpr unsigned kBitsBeforeIpv4 = 96;

std::optional<unsigned> number(const std::string& text) {
  unsigned value = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<IpAddress> ip_address(const std::string& text) {
  IpAddress address{};
  if (::inet_pton(AF_INET6, text.c_str(), address.data()) == 1) return address;
  address[10] = address[11] = 0xff;
  if (::inet_pton(AF_INET, text.c_str(), &address[12]) == 1) return address;
  return std::nullopt;
}

std::optional<AddressRange> AddressRange::from_text(const std::string& text) {
  const auto slash = text.find('/');
  const auto first = ip_address(text.substr(0, slash));
  if (!first) return std::nullopt;
  if (slash == std::string::npos) return AddressRange(*first, kBits);
  const unsigned before = text.find(':') == std::string::npos ? kBitsBeforeIpv4 : 0;
  const auto bits = number(text.substr(slash + 1));
  if (!bits || *bits > kBits - before) return std::nullopt;
  return AddressRange(*first, before + *bits);
}

bool AddressRange::contains(const IpAddress& address) const {
  const auto whole = static_cast<std::ptrdiff_t>(bits_ / 8);
  if (!std::equal(first_.begin(), first_.begin() + whole, address.begin())) return false;
  const unsigned rest = bits_ % 8;
  if (rest == 0) return true;
  const auto at = static_cast<std::size_t>(whole);
  return (first_[at] ^ address[at]) >> (8 - rest) == 0;
}

namespace {

constexpr std::ptrdiff_t kNetworkBytes = 8;

/// Returns the host of `192.0.2.7:80`, `192.0.2.7`, `[2001:db8::1]:80`, `[2001:db8::1]` or
/// `2001:db8::1%eth0`.
std::string without_port(std::string_view text) {
  if (text.starts_with('[')) {
    text = text.substr(1, text.find(']') - 1);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    text = text.substr(0, text.find(':'));
  }
  return std::string(text.substr(0, text.find('%')));
}

bool is_ipv4(IpAddress address) {
  in6_addr binary{};
  std::copy(address.begin(), address.end(), std::begin(binary.s6_addr));
  return IN6_IS_ADDR_V4MAPPED(&binary);
}

std::string name_of(IpAddress address) {
  if (!is_ipv4(address)) std::fill(address.begin() + kNetworkBytes, address.end(), std::uint8_t{0});
  std::array<char, INET6_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET6, address.data(), text.data(), text.size());
}

}  // namespace

std::string client_of(const std::string& peer, const std::string& forwarded,
                      const std::vector<AddressRange>& trusted_proxies) {
  const auto trusted = [&](const IpAddress& address) {
    return std::any_of(trusted_proxies.begin(), trusted_proxies.end(),
                       [&](const AddressRange& range) { return range.contains(address); });
  };
  auto client = ip_address(without_port(peer));
  if (!client) return peer;
  std::string_view rest = forwarded;
  while (trusted(*client) && !rest.empty()) {
    const auto comma = rest.rfind(',');
    const auto last = comma == std::string_view::npos ? rest : rest.substr(comma + 1);
    const auto before = ip_address(without_port(trimmed(last)));
    if (!before) break;
    client = before;
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(0, comma);
  }
  return name_of(*client);
}

}  // namespace fleetplan::server
