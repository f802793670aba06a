
#include "server/http/request/negotiation.h"

#include <algorithm>
#include <cstdlib>

#include "server/http/text.h"

namespace fleetplan::server {

namespace {

struct Weighted {
  std::string name;  // lower case, without parameters
  double quality;    // 0 to 1
};

Weighted parse_weighted(std::string_view item) {
  const auto parts = split(item, ';');
  Weighted weighted{parts.empty() ? std::string() : lower_case(parts.front()), 1.0};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string parameter = lower_case(parts[i]);
    if (!parameter.starts_with("q=")) continue;
    weighted.quality = std::clamp(std::strtod(parameter.c_str() + 2, nullptr), 0.0, 1.0);
  }
  return weighted;
}

/// Returns the quality of a media type by the most specific range of an Accept field; 0 when there is none.
double quality(std::string_view accept, std::string_view type) {
  const std::string_view family = type.substr(0, type.find('/') + 1);
  int best_rank = 0;
  double quality = 0.0;
  for (const auto item : split(accept, ',')) {
    const Weighted range = parse_weighted(item);
    const int rank = range.name == type                        ? 3
                     : range.name == std::string(family) + '*' ? 2
                     : range.name == "*/*"                     ? 1
                                                               : 0;
    if (rank == 0 || rank < best_rank) continue;
    quality = rank > best_rank ? range.quality : std::max(quality, range.quality);
    best_rank = rank;
  }
  return quality;
}

}  // namespace

std::optional<PlanForm> plan_form(std::string_view accept) {
  if (trimmed(accept).empty()) return PlanForm::json;
  const double json = quality(accept, "application/json");
  const double events = quality(accept, "text/event-stream");
  if (json <= 0.0 && events <= 0.0) return std::nullopt;
  return events > json ? PlanForm::events : PlanForm::json;
}

bool accepts_gzip(std::string_view accept_encoding) {
  bool by_star = false;
  for (const auto item : split(accept_encoding, ',')) {
    const Weighted coding = parse_weighted(item);
    if (coding.name == "gzip" || coding.name == "x-gzip") return coding.quality > 0.0;
    if (coding.name == "*") by_star = coding.quality > 0.0;
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
      return "JSON must be encoded in UTF-8: send 'Content-Type: application/json'.";
    }
  }
  if (type.empty()) return "The body has no Content-Type: send 'Content-Type: application/json'.";
  if (type == "application/json" || type.ends_with("+json")) return std::nullopt;
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
