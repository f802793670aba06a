#include "api/response/write_dependencies.h"

#include <string_view>

namespace fleetplan::api {

namespace {

void write_action_progress(JsonWriter& json, std::string_view key, const core::ActionProgress& progress,
                           const std::vector<core::Robot>& robots) {
  json.key(key).begin_object();
  json.member("robot", robots[progress.robot].id).member("action", progress.action);
  json.member("progress", progress.fraction).end_object();
}

}  // namespace

void write_dependencies(JsonWriter& json, const core::Dependencies* dependencies,
                        const std::vector<core::Robot>& robots) {
  if (dependencies == nullptr) {
    json.key("dependencies").json("null").key("tight").json("null");
    return;
  }
  json.key("dependencies").begin_array();
  for (const core::Dependency& one : dependencies->list) {
    json.begin_object();
    write_action_progress(json, "gate", one.gate, robots);
    write_action_progress(json, "until", one.until, robots);
    json.member("slack", one.slack).end_object();
  }
  json.end_array().key("tight").begin_array();
  for (const core::TightPair& one : dependencies->tight) {
    json.begin_object().key("robots").begin_array();
    json.value(robots[one.first].id).value(robots[one.second].id).end_array();
    json.member("t", one.t).member("slack", one.slack).end_object();
  }
  json.end_array();
}

}  // namespace fleetplan::api
