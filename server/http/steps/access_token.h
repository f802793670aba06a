#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace fleetplan::server {

/// The secret that requests must show. It is never logged.
class AccessToken {
 public:
  /// `text`: visible ASCII. What is wrong with it, otherwise, without showing it.
  static std::variant<AccessToken, std::string> from_text(std::string_view text);

  /// The only line of a file; line ends behind it are dropped.
  static std::variant<AccessToken, std::string> from_file(const std::string& path);

  /// True when an Authorization field (empty: absent) shows the token: as `Bearer TOKEN`, or as the password
  /// of `Basic`, with any user name, for which browsers can ask. How long it takes does not depend on how
  /// much of the token is right.
  bool admits(std::string_view authorization) const;

 private:
  explicit AccessToken(std::string_view token) : token_(token) {}
  bool equals(std::string_view shown) const;

  std::string token_;
};

/// RFC 4648, with or without padding; none when it is no base64.
std::optional<std::string> base64_decoded(std::string_view text);

}  // namespace fleetplan::server
