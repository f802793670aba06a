#pragma once

// Tests of requests with one fault each.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "tests/api/support/requests.h"

namespace fleetplan::api {

/// A change of a valid request, and the only fault that it makes.
struct FaultCase {
  std::string name;
  std::function<void(Json&)> modify;
  std::string pointer;
  std::string code;
  std::string detail;  // a part of it
};

inline void PrintTo(const FaultCase& invalid, std::ostream* out) { *out << invalid.name; }

inline Json& robot(Json& request, std::size_t index) { return request["robots"][index]; }

/// Expects the only fault of a valid request after the change.
inline void expect_one_fault(Json request, const FaultCase& invalid) {
  invalid.modify(request);
  const auto faults = faults_of(request.dump());
  EXPECT_THAT(brief(faults), testing::ElementsAre(testing::Pair(invalid.pointer, invalid.code)))
      << request.dump();
  if (!faults.empty()) {
    EXPECT_THAT(faults.front().detail, testing::HasSubstr(invalid.detail));
  }
}

}  // namespace fleetplan::api
