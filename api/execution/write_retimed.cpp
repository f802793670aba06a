#include "api/execution/write_retimed.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include "api/json/json_writer.h"
#include "core/execution/executed_actions.h"
#include "core/model/itinerary.h"

namespace fleetplan::api {

namespace {

/// The new time of a planned one; nothing if that is past.
std::optional<double> new_time(const core::Pace& pace, const core::RetimedRobot& retimed, double planned) {
  const double progress = pace.progress_at(planned);
  const auto action = static_cast<std::size_t>(progress);
  const double fraction = progress - std::floor(progress);
  if (fraction == 0.0) {
    if (action <= retimed.first) return std::nullopt;
    return retimed.ends[action - 1 - retimed.first];
  }
  if (action < retimed.first) return std::nullopt;
  const std::size_t index = action - retimed.first;
  const double begin = index == 0 ? retimed.begin : retimed.ends[index - 1];
  return begin + fraction * (retimed.ends[index] - begin);
}

void write_actions_left(JsonWriter& json, const core::RetimedRobot& retimed) {
  json.key("actions").begin_array();
  double begin = retimed.begin;
  for (std::size_t k = 0; k < retimed.ends.size(); ++k) {
    json.begin_object().member("action", retimed.first + k).member("t_start", begin);
    json.member("t_end", retimed.ends[k]).end_object();
    begin = retimed.ends[k];
  }
  json.end_array();
}

void write_visits_left(JsonWriter& json, const core::Robot& robot, core::Actions actions,
                       const core::RetimedRobot& retimed) {
  const core::Pace pace(actions);
  json.key("visits").begin_array();
  for (const core::Visit& visit : core::visits_of(robot, actions)) {
    const auto arrives = new_time(pace, retimed, visit.t_arrive);
    const bool stays = visit.t_leave == core::kForever;
    const auto leaves = stays ? std::nullopt : new_time(pace, retimed, visit.t_leave);
    if (!arrives && !leaves) continue;
    json.begin_object().member("goal", visit.goal).member("t_arrive", arrives);
    json.member("t_leave", leaves).end_object();
  }
  json.end_array();
}

}  // namespace

std::optional<std::string> write_retimed(const RetimeRequest& request,
                                         const std::vector<core::RetimedRobot>& retimed, core::Work& stop) {
  // An action is as much work as reading so many bytes.
  constexpr std::size_t kWorkOfAnAction = 256;
  const auto actions = core::executed_actions(request.robots, request.plans);
  const auto id = [&](const std::optional<std::size_t>& robot) { return request.robots[*robot].id; };
  JsonWriter json;
  json.begin_object().key("robots").begin_array();
  for (std::size_t k = 0; k < retimed.size(); ++k) {
    if (stop.met_after(kWorkOfAnAction * (1 + actions[k].size()))) return std::nullopt;
    json.begin_object().member("robot", request.robots[k].id);
    json.member("t_end", retimed[k].ends.empty() ? retimed[k].begin : retimed[k].ends.back());
    json.member("delay", retimed[k].delay);
    write_actions_left(json, retimed[k]);
    write_visits_left(json, request.robots[k], actions[k], retimed[k]);
    json.end_object();
  }
  json.end_array().key("late").begin_array();
  for (std::size_t k = 0; k < retimed.size(); ++k) {
    if (!retimed[k].because_of) continue;
    json.begin_object().member("robot", request.robots[k].id).member("delay", retimed[k].delay);
    json.key("waits_for");
    if (retimed[k].waits_for) {
      json.value(id(retimed[k].waits_for));
    } else {
      json.json("null");
    }
    json.member("because_of", id(retimed[k].because_of)).end_object();
  }
  json.end_array().end_object();
  return json.take();
}

}  // namespace fleetplan::api
