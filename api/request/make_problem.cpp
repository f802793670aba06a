#include "api/request/make_problem.h"

#include <array>
#include <charconv>
#include <string>
#include <utility>
#include <variant>

#include "api/json/text.h"

namespace fleetplan::api {

namespace {

/// Of a gap that may be as small as a nanometre: three digits that matter.
std::string metres(double length) {
  std::array<char, 32> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), length, std::chars_format::general, 3);
  return std::string(buffer.data(), result.ptr) + " m";
}

/// The robot's id, or its number when it has none.
std::string called(const std::vector<ReadRobot>& robots, std::size_t index) {
  const std::string& id = robots[index].robot.id;
  return id.empty() ? "number " + std::to_string(index) : in_quotes(id);
}

std::string in_obstacle(const char* pose, const std::string& robot, double radius, double gap) {
  return "The " + std::string(pose) + " of robot " + robot +
         " does not fit: its disk overlaps a blocked cell or the edge of the map by " + metres(-gap) +
         " (radius " + number_text(radius) + " m). Move it or make the robot smaller.";
}

std::string overlap(const char* poses, const std::string& earlier, const std::string& later, double gap) {
  return "The " + std::string(poses) + " of robots " + earlier + " and " + later +
         " overlap: the gap between their disks is " + metres(gap) + "; move them apart.";
}

/// `of`: which of the robots the problem's are.
void add_geometry_fault(const core::ProblemFault& found, const std::vector<ReadRobot>& robots,
                        const std::vector<std::size_t>& of, FaultList& faults) {
  using Kind = core::ProblemFault::Kind;
  const std::size_t index = of[found.robot];
  const ReadRobot& read = robots[index];
  const std::string name = called(robots, index);
  const auto other = [&] { return called(robots, of[found.other]); };
  const auto add = [&](bool start, const char* code, std::string detail) {
    const std::string pointer = "/robots/" + std::to_string(index) + (start ? "/start" : "/goal");
    faults.add(start ? read.start_at : read.goal_at, {pointer, code, std::move(detail)});
  };
  switch (found.kind) {
    case Kind::start_in_obstacle:
      return add(true, fault::kStartInObstacle, in_obstacle("start", name, read.robot.radius, found.gap));
    case Kind::goal_in_obstacle:
      return add(false, fault::kGoalInObstacle, in_obstacle("goal", name, read.robot.radius, found.gap));
    case Kind::starts_overlap:
      return add(true, fault::kStartsOverlap, overlap("starts", other(), name, found.gap));
    case Kind::goals_overlap:
      return add(false, fault::kGoalsOverlap, overlap("goals", other(), name, found.gap));
  }
}

}  // namespace

std::optional<core::Problem> make_problem(core::OccupancyGrid grid, std::vector<ReadRobot> robots,
                                          FaultList& faults) {
  std::vector<core::Robot> placed;
  std::vector<std::size_t> of;
  for (std::size_t index = 0; index < robots.size(); ++index) {
    if (!robots[index].placed) continue;
    placed.push_back(robots[index].robot);
    of.push_back(index);
  }
  auto made = core::Problem::create(std::move(grid), std::move(placed));
  if (const auto* found = std::get_if<std::vector<core::ProblemFault>>(&made)) {
    for (const core::ProblemFault& one : *found) add_geometry_fault(one, robots, of, faults);
  }
  if (!faults.empty()) return std::nullopt;
  return std::get<core::Problem>(std::move(made));
}

}  // namespace fleetplan::api
