#include "server/http/steps/request_id.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace fleetplan::server {

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

}  // namespace fleetplan::server
