#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace fleetplan::server {

/// The secret that requests must send. It is never logged.
class AccessToken {
 public:
  /// `text`: visible ASCII. Otherwise the fault, without the text.
  static std::variant<AccessToken, std::string> from_text(std::string_view text);

  /// The only line of a file; line ends behind it are dropped.
  static std::variant<AccessToken, std::string> from_file(const std::string& path);

  /// True when an Authorization field (empty: absent) contains the token: as `Bearer TOKEN`, or as the
  /// password of `Basic` with any user name, for which browsers show a dialog. The time does not depend on
  /// how much of the token is right.
  bool admits(std::string_view authorization) const;

 private:
  explicit AccessToken(std::string_view token) : token_(token) {}
  bool equals(std::string_view shown) const;

  std::string token_;
};

/// RFC 4648, with or without padding; none when it is not base64.
std::optional<std::string> base64_decoded(std::string_view text);

}  // namespace fleetplan::server
