#include "server/http/steps/access_token.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

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

}  // namespace fleetplan::server
