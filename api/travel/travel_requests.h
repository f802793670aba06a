#pragma once

// The requests of POST /v1/matrix and POST /v1/assign, and their answers.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_reader.h"
#include "api/request/limits.h"
#include "api/request/parse_request.h"
#include "core/geometry/segment.h"
#include "core/map/static_map.h"
#include "core/model/plan_options.h"
#include "core/model/problem.h"
#include "core/runtime/executor.h"
#include "core/runtime/stop_condition.h"
#include "core/travel/travel_times.h"

namespace fleetplan::api {

inline constexpr std::array<std::string_view, 7> kMatrixMembers{"map", "zones",   "robot", "from",
                                                                "to",  "options", "format"};

/// The format of the numbers in a matrix: as they are, with null where there is no way, or as whole numbers.
enum class MatrixFormat { numbers, integers };

/// A pose in the map frame. Without theta, in any heading.
struct MatrixPose {
  core::Position position{0.0, 0.0};
  std::optional<double> theta;
};

/// The poses of a list, each kept once.
struct MatrixPoses {
  std::vector<MatrixPose> distinct;
  std::vector<std::uint32_t> index;  // by item of the list: its pose
};

/// A valid body of POST /v1/matrix.
struct MatrixRequest {
  std::shared_ptr<const core::StaticMap> map;
  core::Robot robot;
  std::vector<core::Zone> zones;  // all are for the robot
  MatrixPoses from;               // the rows
  MatrixPoses to;                 // the columns
  core::PlanOptions options;
  std::chrono::nanoseconds budget;
  MatrixFormat format = MatrixFormat::numbers;
  std::vector<std::string> warnings;

  std::size_t rows() const { return from.index.size(); }
  std::size_t columns() const { return to.index.size(); }
};

/// Reads the root of the document. Returns none if it has faults, or if `work` is met. `maps`, which may be
/// null, has the maps of earlier requests.
std::optional<MatrixRequest> parse_matrix_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& work, core::MapCache* maps);

/// Returns the travel times between distinct poses, by the poses of `to` and then of `from`; see
/// core::travel_times. It computes them for a part of the poses at a time, so that memory suffices for any
/// number.
std::optional<core::TravelAnswers> matrix_times(const MatrixRequest& request, const core::StopCondition& stop,
                                                core::Executor& executor, const std::function<bool()>& go_on);

/// Returns the answer with these times; none if `stop` is met first.
std::optional<std::string> write_matrix(const MatrixRequest& request, const core::TravelAnswers& answers,
                                        const core::StopCondition& stop);

inline constexpr std::array<std::string_view, 2> kAssignMembers{"request", "tasks"};

/// The members of a task that the core's task does not have.
struct ReceivedTask {
  std::string id;
  double weight = 1.0;
  JsonReader goals;  // its member
};

/// A valid body of POST /v1/assign.
struct AssignRequest {
  PlanRequest plan;
  std::vector<core::Task> tasks;
  std::vector<ReceivedTask> received;  // by task
  JsonReader request;                  // the member of the body
};

/// Reads the root of the document. Returns none if it has faults, or if `work` is met. `maps`, which may be
/// null, has the maps of earlier requests.
std::optional<AssignRequest> parse_assign_request(const JsonReader& root, const Limits& limits,
                                                  core::Work& work, core::MapCache* maps);

/// Who does a task.
struct Assigned {
  std::optional<std::size_t> robot = {};  // nullopt: no robot has it
  double t_arrive = core::kForever;       // seconds
  bool any_way = false;                   // whether any robot could do it
};

/// Gives each task to at most one robot, and each robot at most one task. If there are too few robots, the
/// assignment leaves out the tasks of least total weight. It then minimizes the sum of weighted arrivals;
/// `arrivals` as by core::arrivals(). Returns, by task, which robot does it; none if `stop` is met first.
std::optional<std::vector<Assigned>> assigned(const AssignRequest& request,
                                              const std::vector<std::vector<double>>& arrivals,
                                              const core::StopCondition& stop);

/// Returns the request of the body with the results. The goals of the tasks follow the goals that their
/// robots have. `assigned` and `unassigned` are added.
std::string write_assigned(const AssignRequest& request, const std::vector<Assigned>& assigned);

}  // namespace fleetplan::api
