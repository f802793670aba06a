#include "server/negotiation.h"

#include <cstdlib>

#include "server/text.h"

namespace fleetplan::server {

namespace {

struct Weighted {
  std::string name;  // lower case, without parameters
  bool allowed;      // q > 0
};

Weighted parse_weighted(std::string_view item) {
  const auto parts = split(item, ';');
  Weighted weighted{parts.empty() ? std::string() : lower_case(parts.front()), true};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string parameter = lower_case(parts[i]);
    if (parameter.starts_with("q=")) weighted.allowed = std::strtod(parameter.c_str() + 2, nullptr) > 0.0;
  }
  return weighted;
}

}  // namespace

bool accepts_json(std::string_view accept) {
  if (trimmed(accept).empty()) return true;
  int best_rank = 0;
  bool allowed = false;
  for (const auto item : split(accept, ',')) {
    const Weighted range = parse_weighted(item);
    const int rank = range.name == "application/json" ? 3
                     : range.name == "application/*"  ? 2
                     : range.name == "*/*"            ? 1
                                                      : 0;
    if (rank > best_rank) {
      best_rank = rank;
      allowed = range.allowed;
    } else if (rank > 0 && rank == best_rank) {
      allowed = allowed || range.allowed;
    }
  }
  return allowed;
}

bool accepts_gzip(std::string_view accept_encoding) {
  bool by_star = false;
  for (const auto item : split(accept_encoding, ',')) {
    const Weighted coding = parse_weighted(item);
    if (coding.name == "gzip" || coding.name == "x-gzip") return coding.allowed;
    if (coding.name == "*") by_star = coding.allowed;
  }
  return by_star;
}

std::optional<std::string> content_type_fault(std::string_view content_type) {
  const auto parts = split(content_type, ';');
  const std::string type = parts.empty() ? std::string() : lower_case(parts.front());
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string parameter = lower_case(parts[i]);
    if (parameter.starts_with("charset=") && parameter != "charset=utf-8" &&
        parameter != "charset=\"utf-8\"" && parameter != "charset=us-ascii") {
      return "JSON is taken in UTF-8 only: send 'Content-Type: application/json'.";
    }
  }
  if (type.empty() || type == "application/json" || type.ends_with("+json")) return std::nullopt;
  if (type == "application/x-www-form-urlencoded") {
    return "The body is declared a web form, as 'curl -d' does: use 'curl --json', or add "
           "-H 'Content-Type: application/json'.";
  }
  return std::string("The body is declared ") + in_quotes(type) + ": send 'Content-Type: application/json'.";
}

ContentCoding content_coding(std::string_view content_encoding) {
  const std::string coding = lower_case(trimmed(content_encoding));
  if (coding.empty() || coding == "identity") return ContentCoding::identity;
  if (coding == "gzip" || coding == "x-gzip") return ContentCoding::gzip;
  return ContentCoding::unknown;
}

}  // namespace fleetplan::server
