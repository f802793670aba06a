#include "server/http/route_table.h"

#include <optional>
#include <utility>

namespace fleetplan::server {

namespace {

/// Returns the part of `path` that a route's braces stand for. For the file of a folder, the whole path; for
/// a route without braces, an empty text. None if the route does not match.
std::optional<std::string_view> matched(const Route& route, std::string_view path) {
  const std::string_view declared = route.path;
  const auto brace = declared.find('{');
  const bool is_variable = route.contains || brace != std::string_view::npos;
  if (!is_variable) return path == declared ? std::optional(std::string_view()) : std::nullopt;
  if (path.size() > RouteTable::kMaxVariablePath) return std::nullopt;
  if (route.contains) return path == declared || route.contains(path) ? std::optional(path) : std::nullopt;
  return path.starts_with(declared.substr(0, brace)) ? std::optional(path.substr(brace)) : std::nullopt;
}

}  // namespace

bool Route::allows(std::string_view sent_method) const {
  return sent_method == method || (method == "GET" && sent_method == "HEAD");
}

void RouteTable::get(std::string path, Handler handler, RouteTraits traits) {
  routes_.push_back({"GET", std::move(path), std::move(handler), std::move(traits)});
}

void RouteTable::post(std::string path, Handler handler, RouteTraits traits) {
  routes_.push_back({"POST", std::move(path), std::move(handler), std::move(traits)});
}

void RouteTable::files(std::string path, std::function<bool(std::string_view path)> contains, Handler handler,
                       RouteTraits traits) {
  routes_.push_back({"GET", std::move(path), std::move(handler), std::move(traits), std::move(contains)});
}

RouteTable::Match RouteTable::find(std::string_view path) const {
  for (const Route& route : routes_) {
    if (const auto parameter = matched(route, path)) return {&route, std::string(*parameter)};
  }
  return {};
}

}  // namespace fleetplan::server
