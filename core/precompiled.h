#pragma once

// Headers that most sources include, directly or through a header of core/. CMake precompiles them, which
// halves the time of a build. Sources still include what they use. Builds without precompiled headers
// (CMAKE_DISABLE_PRECOMPILE_HEADERS) check that.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>
