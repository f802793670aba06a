#pragma once

#include <cstddef>
#include <cstdint>

/// What every fuzz target defines, under the name that libFuzzer wants: tries one input and returns 0, or
/// ends the process when something does not hold.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
