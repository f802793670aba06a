#pragma once

// Numbers with units, as the details of violations tell them.

#include <array>
#include <cstdio>
#include <string>

namespace fleetplan::core {

inline std::string in_words(double value, const char* unit) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.6g %s", value, unit);
  return text.data();
}

inline std::string metres(double value) { return in_words(value, "m"); }
inline std::string seconds(double value) { return in_words(value, "s"); }
inline std::string radians(double value) { return in_words(value, "rad"); }

}  // namespace fleetplan::core
