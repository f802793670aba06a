#pragma once

// Requests and answers that are moved in the world.

#include <string>

#include "tests/api/support/requests.h"

namespace fleetplan::api {

/// Returns JSON all of whose positions, objects with x and y, are moved by so many metres. A map without an
/// origin gets one.
inline Json moved(const Json& json, double x, double y) {
  if (!json.is_structured()) return json;
  Json copy = json.is_array() ? Json::array() : Json::object();
  if (json.is_array()) {
    for (const Json& item : json) copy.push_back(moved(item, x, y));
    return copy;
  }
  for (const auto& [key, value] : json.items()) copy[key] = moved(value, x, y);
  const auto has = [&](const char* key) { return copy.contains(key) && copy.at(key).is_number(); };
  if (has("x") && has("y")) {
    copy["x"] = copy.at("x").get<double>() + x;
    copy["y"] = copy.at("y").get<double>() + y;
  }
  if (copy.contains("map") && !copy.at("map").contains("origin"))
    copy["map"]["origin"] = {{"x", x}, {"y", y}};
  return copy;
}

}  // namespace fleetplan::api
