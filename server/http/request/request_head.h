#pragma once

// The head of an HTTP/1.x request: request line and header fields, parsed strictly (RFC 9112). Input that two
// parsers read differently allows request smuggling.
//
// Also the characters of fields and trailers (RFC 9110, 5.6). Also two ids by which a request is found in
// logs: its own id, and the id of its trace.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fleetplan::server {

/// The authority of a URI without user information (RFC 3986, 3.2): `host[:port]`.
struct Authority {
  std::string host;  // in lower case; an IPv6 address with its brackets
  std::string port;  // digits; empty: the scheme's default port
};

/// Parses an authority. Returns none if it is malformed or has no host.
std::optional<Authority> parse_authority(std::string_view text);

/// Whether a name belongs to this machine alone: localhost, 127.0.0.0/8 and ::1, the last with or without
/// brackets.
bool is_local_name(std::string_view host);

inline bool is_token_char(char c) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         kMarks.find(c) != std::string_view::npos;
}

inline bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_char);
}

inline bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

inline bool is_field_value_char(char c) { return c == '\t' || !is_control(c); }

/// Whether a line, without its end, is a field: `name: value`.
inline bool is_field_line(std::string_view line) {
  const auto colon = line.find(':');
  return colon != std::string_view::npos && is_token(line.substr(0, colon)) &&
         std::all_of(line.begin() + static_cast<std::ptrdiff_t>(colon), line.end(), is_field_value_char);
}

inline constexpr std::size_t kMaxHeadBytes = 32 * 1024;
inline constexpr std::size_t kMaxTargetBytes = 8 * 1024;
inline constexpr std::size_t kMaxHeaderFields = 100;

/// Names and values of header fields, in their order. A name may occur several times.
using HeaderFields = std::vector<std::pair<std::string, std::string>>;

struct RequestHead {
  std::string method;    // as sent, e.g. "POST"
  std::string raw_path;  // as sent, without query
  std::string path;      // percent-decoded
  /// The host in the target, otherwise the host in the Host field, as sent. None: HTTP/1.0 without Host.
  std::optional<std::string> host = std::nullopt;
  bool http_1_0 = false;
  HeaderFields fields;                          // names in lower case, values trimmed
  std::optional<std::uint64_t> content_length;  // bytes
  bool chunked = false;

  /// Returns all values of a field (name in lower case) joined by ", "; empty when absent.
  std::string field(std::string_view name) const;
  bool has_field(std::string_view name) const;

  /// Whether the client expects the connection to stay open after the answer.
  bool keeps_alive() const;
};

/// Why a head is rejected.
struct BadHead {
  enum class Kind { malformed, target_too_long, too_large };
  std::string detail;
  Kind kind = Kind::malformed;
};

/// Returns the fault of a head of more than kMaxHeadBytes: its target or its fields are too long.
BadHead too_large_head(std::string_view begun);

/// Parses a head: `text` is everything from the request line to the empty line, which is included.
std::variant<RequestHead, BadHead> parse_request_head(std::string_view text);

/// Decodes percent-encoding: `%41` -> `A`. Returns none if an escape is broken or yields a control character.
std::optional<std::string> percent_decoded(std::string_view text);

/// Finds the end of a head in a growing buffer, looking at each byte once.
class HeadScanner {
 public:
  enum class State { incomplete, complete, malformed };

  /// Scans a buffer that begins with what was scanned before.
  State scan(std::string_view buffer);

  /// The number of bytes of the head with its empty line; valid once complete.
  std::size_t size() const { return position_; }

 private:
  std::size_t position_ = 0;
  std::size_t line_start_ = 0;
};

/// Whether an id has 1..128 characters of [A-Za-z0-9._-]: safe in a header, a log line and a file name.
bool is_well_formed_request_id(std::string_view id);

/// Returns 128 random bits as 32 hexadecimal digits.
std::string make_request_id();

/// Returns the trace_id, 32 hexadecimal digits, of a `traceparent` field (W3C Trace Context). None if the
/// field is absent (empty) or malformed.
std::optional<std::string> trace_id_of(std::string_view traceparent);

}  // namespace fleetplan::server
