#pragma once

// What a fuzz target is. A program has all of them, or one for libFuzzer.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace fleetplan::fuzz {

using Input = std::span<const std::uint8_t>;

inline std::string_view text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// Runs one input; aborts the process if a check fails.
using Run = void (*)(Input input);

/// The targets of this program, by their names.
inline std::map<std::string, Run>& targets() {
  static std::map<std::string, Run> all;
  return all;
}

/// Every source of a target defines a Target, which adds itself to the program's targets.
struct Target {
  Target(const char* name, Run run) { targets()[name] = run; }
};

}  // namespace fleetplan::fuzz
