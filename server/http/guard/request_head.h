#pragma once

// The head of an HTTP/1.x request: request line and header fields, parsed strictly (RFC 9112). Input that two
// parsers read differently allows request smuggling.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fleetplan::server {

inline constexpr std::size_t kMaxHeadBytes = 32 * 1024;
inline constexpr std::size_t kMaxTargetBytes = 8 * 1024;
inline constexpr std::size_t kMaxHeaderFields = 100;

/// Names and values of header fields, in their order; a name may occur several times.
using HeaderFields = std::vector<std::pair<std::string, std::string>>;

struct RequestHead {
  std::string method;    // as sent, e.g. "POST"
  std::string raw_path;  // as sent, without query
  std::string path;      // percent-decoded
  /// Of the target, else of the Host field, as sent; none: HTTP/1.0 without Host.
  std::optional<std::string> host = std::nullopt;
  bool http_1_0 = false;
  HeaderFields fields;                          // names in lower case, values trimmed
  std::optional<std::uint64_t> content_length;  // bytes
  bool chunked = false;

  /// All values of a field (name in lower case) joined by ", "; empty when absent.
  std::string field(std::string_view name) const;
  bool has_field(std::string_view name) const;

  /// The client expects the connection to stay open after the answer.
  bool keeps_alive() const;
};

/// Why a head is rejected.
struct BadHead {
  enum class Kind { malformed, target_too_long, too_large };
  std::string detail;
  Kind kind = Kind::malformed;
};

/// For a head of which more than kMaxHeadBytes have arrived: its target or its fields are too long.
BadHead too_large_head(std::string_view begun);

/// `text`: everything from the request line to the empty line, which is included.
std::variant<RequestHead, BadHead> parse_request_head(std::string_view text);

/// `%41` -> `A`; none when an escape is broken or yields a control character.
std::optional<std::string> percent_decoded(std::string_view text);

/// Finds the end of a head in a growing buffer, looking at each byte once.
class HeadScanner {
 public:
  enum class State { incomplete, complete, malformed };

  /// `buffer` must begin with what was scanned before.
  State scan(std::string_view buffer);

  /// Bytes of the head with its empty line; valid once complete.
  std::size_t size() const { return position_; }

 private:
  std::size_t position_ = 0;
  std::size_t line_start_ = 0;
};

}  // namespace fleetplan::server
