#include "server/request_id.h"

#include <algorithm>
#include <random>

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
  std::random_device device;
  std::string id;
  for (int word = 0; word < 4; ++word) {
    std::uint32_t bits = device();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4) id += kDigits[bits & 0xf];
  }
  return id;
}

std::string request_id_from(std::string_view sent) {
  return is_well_formed_request_id(sent) ? std::string(sent) : make_request_id();
}

}  // namespace fleetplan::server
