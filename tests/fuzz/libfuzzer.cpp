// The function that libFuzzer calls with each input, for a program with one target.

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/target.h"

// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fleetplan::fuzz::Run run = fleetplan::fuzz::targets().begin()->second;
  run({data, size});
  return 0;
}
