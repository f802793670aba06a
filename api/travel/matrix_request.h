#pragma once

// The request of POST /v1/matrix and its answer.

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "core/map/static_map.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/work.h"
#include "core/travel/travel_times.h"

namespace fleetplan::api {

inline constexpr std::array<std::string_view, 6> kMatrixMembers{"map",  "zones", "robot",
                                                                "from", "to",    "options"};

/// A valid body of POST /v1/matrix.
struct MatrixRequest {
  core::Problem problem;  // the robot once for each pose of `from`, one at a time, in the map frame
  core::PlanOptions options;
  core::TravelQuestions questions;  // a column for each pose of `to`
  std::chrono::nanoseconds budget;
  std::vector<std::string> warnings;

  std::size_t rows() const { return problem.robots().size(); }
  std::size_t columns() const { return questions.columns.size(); }
};

/// Reads the root of the document. Nothing if it has faults, or if its stop is met. `maps`, which may be
/// null, has the maps of earlier requests.
std::optional<MatrixRequest> parse_matrix_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& stop, core::MapCache* maps);

/// The answer; none if `stop` is met first.
std::optional<std::string> write_matrix(const MatrixRequest& request, const core::TravelAnswers& answers,
                                        const core::StopCondition& stop);

}  // namespace fleetplan::api
