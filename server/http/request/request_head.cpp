#include "server/http/request/request_head.h"

#include <arpa/inet.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

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

namespace {

using Parsed = std::variant<RequestHead, BadHead>;

/// Takes the next line off `rest` and returns it without its CR LF.
std::string_view take_line(std::string_view& rest) {
  const auto end = rest.find("\r\n");
  const auto line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 2);
  return line;
}

/// Reads a request target (RFC 9112, 3.2). It is in origin-form (`/a?b`), absolute-form (`http://host/a?b`)
/// or, for OPTIONS, asterisk-form. No form has a fragment.
std::optional<BadHead> parse_target(std::string_view target, RequestHead& head) {
  if (target.find('#') != std::string_view::npos) return BadHead{"The request target contains a fragment."};
  const auto scheme_end = target.find("://");
  const std::string scheme =
      scheme_end == std::string_view::npos ? "" : lower_case(target.substr(0, scheme_end));
  if (scheme == "http" || scheme == "https") {
    target.remove_prefix(scheme_end + 3);
    const auto authority = target.substr(0, target.find_first_of("/?"));
    if (!parse_authority(authority)) return BadHead{"The request target has no valid host."};
    head.host = std::string(authority);
    target.remove_prefix(authority.size());
  } else if (!target.starts_with('/') && (target != "*" || head.method != "OPTIONS")) {
    return BadHead{"The request target is neither a path nor an HTTP address."};
  }
  const auto raw_path = target.substr(0, target.find('?'));
  head.raw_path = std::string(raw_path.empty() ? std::string_view("/") : raw_path);
  auto path = percent_decoded(head.raw_path);
  if (!path) return BadHead{"The path is not percent-encoded properly."};
  head.path = std::move(*path);
  return std::nullopt;
}

BadHead target_too_long() {
  return {"The request target is longer than " + std::to_string(kMaxTargetBytes) + " bytes.",
          BadHead::Kind::target_too_long};
}

std::optional<BadHead> parse_request_line(std::string_view line, RequestHead& head) {
  const auto first = line.find(' ');
  const auto last = line.rfind(' ');
  if (first == std::string_view::npos || first == last)
    return BadHead{"The request line is not that of an HTTP/1.1 request."};
  const auto target = line.substr(first + 1, last - first - 1);
  const auto version = line.substr(last + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    return BadHead{"This server supports HTTP/1.1 and HTTP/1.0."};
  }
  if (target.size() > kMaxTargetBytes) return target_too_long();
  head.method = line.substr(0, first);
  head.http_1_0 = version == "HTTP/1.0";
  if (!is_token(head.method)) return BadHead{"The method is not a token."};
  if (target.find(' ') != std::string_view::npos || std::any_of(target.begin(), target.end(), is_control)) {
    return BadHead{"The request target contains a space or a control character."};
  }
  return parse_target(target, head);
}

std::optional<BadHead> parse_field(std::string_view line, RequestHead& head) {
  const auto colon = line.find(':');
  const auto name = line.substr(0, colon);
  if (colon == std::string_view::npos || !is_token(name)) {
    return BadHead{"A header line is not of the form 'name: value'."};
  }
  const auto value = trimmed(line.substr(colon + 1));
  if (!std::all_of(value.begin(), value.end(), is_field_value_char)) {
    return BadHead{"A header value contains a control character."};
  }
  head.fields.emplace_back(lower_case(name), value);
  return std::nullopt;
}

/// Reads the Host field. HTTP/1.1 demands exactly one, which may be empty, HTTP/1.0 none (RFC 9112, 3.2).
std::optional<BadHead> parse_host(RequestHead& head) {
  const auto fields = std::count_if(head.fields.begin(), head.fields.end(),
                                    [](const auto& entry) { return entry.first == "host"; });
  if (fields > 1) return BadHead{"There is more than one Host field."};
  if (fields == 0 && !head.http_1_0) return BadHead{"A request of HTTP/1.1 must have a Host field."};
  if (fields == 0) return std::nullopt;
  std::string host = head.field("host");
  if (!host.empty() && !parse_authority(host)) return BadHead{"The Host field is not a host with its port."};
  if (!head.host) head.host = std::move(host);
  return std::nullopt;
}

std::optional<std::uint64_t> parse_length(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<BadHead> parse_framing(RequestHead& head) {
  const std::string length = head.field("content-length");
  if (head.has_field("transfer-encoding")) {
    if (head.has_field("content-length")) {
      return BadHead{"Content-Length and Transfer-Encoding must not be combined."};
    }
    if (head.http_1_0 || lower_case(head.field("transfer-encoding")) != "chunked") {
      return BadHead{"The only supported transfer coding is 'chunked', with HTTP/1.1."};
    }
    head.chunked = true;
  } else if (head.has_field("content-length")) {
    head.content_length = parse_length(length);
    if (!head.content_length) return BadHead{"Content-Length must be one number of bytes, not negative."};
  }
  return std::nullopt;
}

}  // namespace

std::string RequestHead::field(std::string_view name) const {
  std::string joined;
  bool first = true;
  for (const auto& [key, value] : fields) {
    if (key != name) continue;
    if (!first) joined += ", ";
    joined += value;
    first = false;
  }
  return joined;
}

bool RequestHead::has_field(std::string_view name) const {
  return std::any_of(fields.begin(), fields.end(), [&](const auto& entry) { return entry.first == name; });
}

bool RequestHead::keeps_alive() const {
  const std::string connection = lower_case(field("connection"));
  const auto options = split(connection, ',');
  const auto has = [&](std::string_view option) {
    return std::find(options.begin(), options.end(), option) != options.end();
  };
  return http_1_0 ? has("keep-alive") : !has("close");
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      unsigned value = 0;
      const char* digits = text.data() + i + 1;
      const auto [end, error] = std::from_chars(digits, digits + 2, value, 16);
      if (error != std::errc{} || end != digits + 2) return std::nullopt;
      c = static_cast<char>(value);
      i += 2;
    }
    if (is_control(c)) return std::nullopt;
    decoded += c;
  }
  return decoded;
}

Parsed parse_request_head(std::string_view text) {
  RequestHead head;
  if (auto bad = parse_request_line(take_line(text), head)) return *bad;
  while (!text.empty()) {
    const auto line = take_line(text);
    if (line.empty()) break;
    if (head.fields.size() == kMaxHeaderFields) {
      return BadHead{"There are more than " + std::to_string(kMaxHeaderFields) + " header fields.",
                     BadHead::Kind::too_large};
    }
    if (auto bad = parse_field(line, head)) return *bad;
  }
  if (auto bad = parse_host(head)) return *bad;
  if (auto bad = parse_framing(head)) return *bad;
  return head;
}

BadHead too_large_head(std::string_view begun) {
  if (begun.substr(0, kMaxTargetBytes).find("\r\n") == std::string_view::npos) return target_too_long();
  return {"The request's head is longer than " + std::to_string(kMaxHeadBytes) + " bytes.",
          BadHead::Kind::too_large};
}

HeadScanner::State HeadScanner::scan(std::string_view buffer) {
  for (; position_ < buffer.size(); ++position_) {
    if (buffer[position_] != '\n') continue;
    // Parsers disagree on whether a lone LF ends a line.
    if (position_ == 0 || buffer[position_ - 1] != '\r') return State::malformed;
    const bool empty_line = position_ - line_start_ == 1;
    line_start_ = position_ + 1;
    if (empty_line) {
      ++position_;
      return State::complete;
    }
  }
  return State::incomplete;
}

namespace {

constexpr std::size_t kMaxLength = 128;

bool allowed(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
         c == '-';
}

}  // namespace

bool is_well_formed_request_id(std::string_view id) {
  return !id.empty() && id.size() <= kMaxLength && std::all_of(id.begin(), id.end(), allowed);
}

std::string make_request_id() {
  constexpr char kDigits[] = "0123456789abcdef";
  // std::random_device takes 20 microseconds on some machines, a tenth of a small request.
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("getrandom gives no bytes");  // never for so few
  }
  std::string id;
  for (const unsigned char byte : bytes) {
    id += kDigits[byte >> 4];
    id += kDigits[byte & 0xf];
  }
  return id;
}

namespace {

/// The size of a field 00-TRACE_ID-PARENT_ID-FLAGS. Later versions may append further parts.
constexpr std::size_t kSize = 55;
constexpr std::size_t kTraceIdAt = 3;
constexpr std::size_t kParentIdAt = 36;
constexpr std::size_t kFlagsAt = 53;

bool is_hexadecimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

/// Whether a text is an id. Ids of zeros are invalid.
bool is_id(std::string_view text) {
  return is_hexadecimal(text) && text.find_first_not_of('0') != std::string_view::npos;
}

bool has_dashes(std::string_view traceparent) {
  return traceparent[kTraceIdAt - 1] == '-' && traceparent[kParentIdAt - 1] == '-' &&
         traceparent[kFlagsAt - 1] == '-';
}

/// Whether a version, ff excepted, has a field of this number of bytes.
bool is_version(std::string_view version, std::string_view traceparent) {
  if (version == "00") return traceparent.size() == kSize;
  return is_hexadecimal(version) && version != "ff" &&
         (traceparent.size() == kSize || traceparent[kSize] == '-');
}

}  // namespace

std::optional<std::string> trace_id_of(std::string_view traceparent) {
  if (traceparent.size() < kSize || !has_dashes(traceparent)) return std::nullopt;
  const auto trace_id = traceparent.substr(kTraceIdAt, 32);
  const bool well_formed = is_version(traceparent.substr(0, 2), traceparent) && is_id(trace_id) &&
                           is_id(traceparent.substr(kParentIdAt, 16)) &&
                           is_hexadecimal(traceparent.substr(kFlagsAt, 2));
  return well_formed ? std::optional(std::string(trace_id)) : std::nullopt;
}

}  // namespace fleetplan::server
