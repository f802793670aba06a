#include "api/response/write_actions.h"

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/geometry/angle.h"

namespace fleetplan::api {

namespace {

std::string_view type_name(core::Action::Type type) {
  switch (type) {
    case core::Action::Type::rotate:
      return "rotate";
    case core::Action::Type::translate:
      return "translate";
    case core::Action::Type::wait:
      break;
  }
  return "wait";
}

bool same(const core::Pose& a, const core::Pose& b) { return a.position == b.position && a.theta == b.theta; }

bool same(const core::Action& a, const core::Action& b) {
  return a.type == b.type && a.t_start == b.t_start && a.t_end == b.t_end && same(a.from, b.from) &&
         same(a.to, b.to) && a.reverse == b.reverse;
}

class ActionWriter {
 public:
  ActionWriter(JsonWriter& json, const core::Robot& robot, const ReceivedRobot& received,
               const core::Position& origin)
      : json_(json), robot_(robot), received_(received), origin_(origin) {}

  void write(const core::Action& action, std::size_t index) {
    if (const core::Action* world = as_received(action, index)) {
      write_members(action, world->t_start, world->t_end, world->from, world->to);
      end_ = End{action.to.position, world->to.position};
    } else {
      write_members(action, action.t_start, action.t_end, to_world(action.from), to_world(action.to));
    }
  }

 private:
  /// A position that was received, in the map frame and in the world.
  struct End {
    core::Position map;
    core::Position world;
  };

  /// The action of the request that this one repeats, if it differs in the world; otherwise null.
  const core::Action* as_received(const core::Action& action, std::size_t index) const {
    if (index < robot_.committed.size() && same(action, robot_.committed[index])) {
      return received_.committed.find(index);
    }
    if (robot_.previous && index < robot_.previous->size() && same(action, (*robot_.previous)[index])) {
      return received_.previous.find(index);
    }
    return nullptr;
  }

  core::Pose to_world(const core::Pose& pose) const {
    const bool at_end = end_ && end_->map == pose.position;
    return {at_end ? end_->world : core::Position(pose.position + origin_),
            core::normalize_angle(pose.theta)};
  }

  void write_members(const core::Action& action, double t_start, double t_end, const core::Pose& from,
                     const core::Pose& to) {
    json_.begin_object();
    json_.member("type", type_name(action.type));
    json_.member("t_start", t_start).member("t_end", t_end);
    if (action.goal) json_.member("goal", *action.goal);
    if (action.reverse) json_.member("reverse", true);
    write_pose("from", from);
    write_pose("to", to);
    json_.end_object();
  }

  void write_pose(std::string_view key, const core::Pose& pose) {
    json_.key(key).begin_object();
    json_.member("x", pose.position.x()).member("y", pose.position.y()).member("theta", pose.theta);
    json_.end_object();
  }

  JsonWriter& json_;
  const core::Robot& robot_;
  const ReceivedRobot& received_;
  const core::Position& origin_;
  std::optional<End> end_;  // of the last action with the numbers received
};

}  // namespace

void write_actions(JsonWriter& json, const std::vector<core::Action>& actions, const core::Robot& robot,
                   const ReceivedRobot& received, const core::Position& origin) {
  ActionWriter writer(json, robot, received, origin);
  json.key("actions").begin_array();
  for (std::size_t index = 0; index < actions.size(); ++index) writer.write(actions[index], index);
  json.end_array();
}

}  // namespace fleetplan::api
