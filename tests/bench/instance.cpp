#include "tests/bench/instance.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace fleetplan::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json read_json_file(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  json document = json::parse(stream, nullptr, false);
  if (document.is_discarded()) throw std::runtime_error(file.string() + " is not JSON");
  return document;
}

bool is_request(const json& document) {
  return document.is_object() && document.contains("map") && document.contains("robots") &&
         document["robots"].is_array();
}

json pose(const core::Position& position, double theta) {
  return {{"x", position.x()}, {"y", position.y()}, {"theta", theta}};
}

json map_rows(const core::OccupancyGrid& grid) {
  json rows = json::array();
  for (int row = grid.rows() - 1; row >= 0; --row) {
    std::string cells;
    for (int column = 0; column < grid.columns(); ++column) cells += grid.blocked({column, row}) ? '#' : '.';
    rows.push_back(std::move(cells));
  }
  return rows;
}

}  // namespace

std::string Instance::body(std::size_t robots, const json& options, const json& defaults) const {
  json request = json::object();
  for (const auto& [key, value] : request_.items()) {
    if (key != "robots") request[key] = value;
  }
  const json& all = request_.at("robots");
  const auto count = static_cast<json::difference_type>(std::min(robots, all.size()));
  request["robots"] = json(json::array_t(all.begin(), all.begin() + count));
  if (!request.contains("options")) request["options"] = json::object();
  request["options"].update(options);
  if (defaults.empty()) return request.dump();
  if (!request.contains("robot_defaults")) request["robot_defaults"] = json::object();
  request["robot_defaults"].update(defaults);
  return request.dump();
}

Instance make_instance(std::string name, const Workload& workload) {
  json robots = json::array();
  for (const core::Robot& robot : workload.robots) {
    json made = {{"id", robot.id},
                 {"radius", robot.radius},
                 {"linear_speed", robot.linear_speed},
                 {"angular_speed", robot.angular_speed},
                 {"start", pose(robot.start.position, robot.start.theta)}};
    if (robot.goal) {
      made["goal"] = {{"x", robot.goal->position.x()}, {"y", robot.goal->position.y()}};
      if (robot.goal->theta) made["goal"]["theta"] = *robot.goal->theta;
    }
    robots.push_back(std::move(made));
  }
  json map = {{"rows", map_rows(workload.grid)}, {"resolution", workload.grid.resolution()}};
  return {std::move(name), {{"map", std::move(map)}, {"robots", std::move(robots)}}};
}

Instance read_instance(std::string name, const fs::path& file) {
  json document = read_json_file(file);
  if (!is_request(document)) throw std::runtime_error(file.string() + " is not a request of POST /v1/plan");
  return {std::move(name), std::move(document)};
}

}  // namespace fleetplan::bench
