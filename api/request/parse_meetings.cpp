#include "api/request/parse_meetings.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "api/json/faults.h"
#include "api/request/ranges.h"

namespace fleetplan::api {

namespace {

constexpr std::array<std::string_view, 4> kMeetingMembers{"robots", "robot", "obstacle", "t"};

/// Robots or obstacles by id.
using Names = std::unordered_map<std::string_view, std::size_t>;

/// The index of the robot or obstacle with the id in `member`, which may be absent.
std::optional<std::size_t> find(const JsonReader& member, const Names& names, const char* code,
                                const char* kind) {
  const auto id = member.name();
  if (!id) return std::nullopt;
  const auto found = names.find(*id);
  if (found != names.end()) return found->second;
  member.fault(code, [&] { return std::string("There is no ") + kind + ' ' + in_quotes(*id) + "."; });
  return std::nullopt;
}

class MeetingReader {
 public:
  explicit MeetingReader(const Fleet& fleet) {
    for (std::size_t k = 0; k < fleet.robots.size(); ++k) robots_.emplace(fleet.robots[k].robot.id, k);
    for (std::size_t k = 0; k < fleet.obstacles.size(); ++k) obstacles_.emplace(fleet.obstacles[k].id, k);
  }

  core::Meeting read(const JsonReader& item) const {
    const JsonReader json = item.object(kMeetingMembers);
    core::Meeting meeting;
    meeting.t = json.require("t").number(kDuration).value_or(0.0);
    if (const JsonReader pair = json.find("robots")) {
      read_pair(pair, meeting);
      return meeting;
    }
    meeting.robot = robot(json.require("robot", "; give it with \"obstacle\", or \"robots\"")).value_or(0);
    meeting.obstacle = find(json.require("obstacle"), obstacles_, fault::kUnknownObstacle, "obstacle");
    return meeting;
  }

 private:
  std::optional<std::size_t> robot(const JsonReader& member) const {
    return find(member, robots_, fault::kUnknownRobot, "robot");
  }

  void read_pair(const JsonReader& member, core::Meeting& meeting) const {
    const JsonReader pair = member.array();
    if (pair && pair.size() != 2) pair.fault(fault::kOutOfRange, "robots must be the ids of two robots.");
    if (!pair || pair.size() != 2) return;
    meeting.robot = robot(pair.item(0)).value_or(0);
    meeting.other = robot(pair.item(1));
  }

  Names robots_;
  Names obstacles_;
};

}  // namespace

std::vector<core::Meeting> parse_meetings(const JsonReader& member, const Fleet& fleet) {
  std::vector<core::Meeting> meetings;
  if (!member) return meetings;
  const MeetingReader reader(fleet);
  const std::size_t before = member.fault_count();
  for (const JsonReader item : member.array().items()) {
    const core::Meeting meeting = reader.read(item);
    if (member.fault_count() == before) meetings.push_back(meeting);
  }
  return meetings;
}

void mark_invalid_robots(const JsonReader& unplanned, std::vector<core::Robot>& robots) {
  Names names;
  for (std::size_t k = 0; k < robots.size(); ++k) names.emplace(robots[k].id, k);
  for (const JsonReader item : unplanned.items()) {
    if (item.find("reason").string() != std::string_view("invalid")) continue;
    const auto found = names.find(item.find("robot").string().value_or(""));
    if (found == names.end()) continue;
    core::Robot& robot = robots[found->second];
    robot.invalid = true;
    robot.committed.clear();
  }
}

}  // namespace fleetplan::api
