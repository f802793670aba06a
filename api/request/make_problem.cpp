#include "api/request/make_problem.h"

#include <array>
#include <charconv>
#include <string>
#include <utility>
#include <variant>

#include "api/json/fault_text.h"

namespace fleetplan::api {

namespace {

/// With three significant digits: a gap may be as small as a nanometre.
std::string metres(double length) {
  std::array<char, 32> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), length, std::chars_format::general, 3);
  return std::string(buffer.data(), result.ptr) + " m";
}

/// The robot's id, or its number when it has none.
std::string name_of(const std::vector<ReadRobot>& robots, std::size_t index) {
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

/// `indices`: of the problem's robots in `robots`.
void add_geometry_fault(const core::ProblemFault& found, const std::vector<ReadRobot>& robots,
                        const std::vector<std::size_t>& indices) {
  using Kind = core::ProblemFault::Kind;
  const ReadRobot& read = robots[indices[found.robot]];
  const std::string name = name_of(robots, indices[found.robot]);
  const auto other = [&] { return name_of(robots, indices[found.other]); };
  switch (found.kind) {
    case Kind::start_in_obstacle:
      return read.start.fault(fault::kStartInObstacle,
                              in_obstacle("start", name, read.robot.radius, found.gap));
    case Kind::goal_in_obstacle:
      return read.goal.fault(fault::kGoalInObstacle, in_obstacle("goal", name, read.robot.radius, found.gap));
    case Kind::starts_overlap:
      return read.start.fault(fault::kStartsOverlap, overlap("starts", other(), name, found.gap));
    case Kind::goals_overlap:
      return read.goal.fault(fault::kGoalsOverlap, overlap("goals", other(), name, found.gap));
    case Kind::committed_collision:
      return;
  }
}

}  // namespace

std::optional<core::Problem> make_problem(core::OccupancyGrid grid, const std::vector<ReadRobot>& robots,
                                          const JsonReader& root, ParseStop& stop) {
  std::vector<core::Robot> placed;
  std::vector<std::size_t> indices;
  for (std::size_t index = 0; index < robots.size(); ++index) {
    if (!robots[index].placed) continue;
    placed.push_back(robots[index].robot);
    indices.push_back(index);
  }
  auto made = core::Problem::create(std::move(grid), std::move(placed), stop.condition());
  if (auto* problem = std::get_if<core::Problem>(&made)) return std::move(*problem);
  const auto& faults = std::get<core::ProblemFaults>(made);
  for (const auto& found : faults.listed) add_geometry_fault(found, robots, indices);
  root.count_more_faults(faults.total - faults.listed.size());
  if (!faults.finished) stop.look();
  return std::nullopt;
}

}  // namespace fleetplan::api
