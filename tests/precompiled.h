#pragma once

// Headers that most tests include; see core/precompiled.h.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/precompiled.h"
