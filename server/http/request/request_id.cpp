#include "server/http/request/request_id.h"

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
