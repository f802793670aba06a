#pragma once

// Numbers with units for the details of violations.

#include <array>
#include <cstdio>
#include <string>

namespace fleetplan::core {

inline std::string quantity_text(double value, const char* unit) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.6g %s", value, unit);
  return text.data();
}

inline std::string metres(double value) { return quantity_text(value, "m"); }
inline std::string seconds(double value) { return quantity_text(value, "s"); }
inline std::string radians(double value) { return quantity_text(value, "rad"); }

}  // namespace fleetplan::core
