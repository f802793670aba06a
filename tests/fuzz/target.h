#pragma once

#include <cstddef>
#include <cstdint>

/// Every fuzz target defines this function, with the name that libFuzzer requires. It runs one input and
/// returns 0, or aborts the process if a check fails.
// NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
