#include "server/command/map2request/map_to_request.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <ostream>
#include <string_view>

#include "api/json/json_writer.h"
#include "api/request/parse_request.h"
#include "server/command/files.h"
#include "server/command/map2request/robot_table.h"
#include "server/command/map2request/ros_map_file.h"

namespace fleetplan::server {

namespace {

constexpr std::string_view kOfImage = "/map/image/";
constexpr std::string_view kOfRobots = "/robots/";

std::string request_of(const RosMapFile& map, const RobotTable& table) {
  api::JsonWriter json;
  json.begin_object().key("map").begin_object().key("image").json(map.json).end_object();
  json.key("robots").json(table.json).end_object();
  return json.take() + '\n';
}

/// The fault of a robot: its line and, if it is one, its column.
InputFault fault_of_robot(const api::Fault& fault, const RobotTable& table) {
  const std::string_view steps = std::string_view(fault.pointer).substr(kOfRobots.size());
  std::size_t robot = 0;
  const auto [end, error] = std::from_chars(steps.data(), steps.data() + steps.size(), robot);
  const std::size_t line = error == std::errc() && robot < table.lines.size() ? table.lines[robot] : 0;
  std::string column(end, steps.data() + steps.size());
  if (!column.empty()) column.erase(0, 1);
  std::replace(column.begin(), column.end(), '/', '_');
  return input_fault(table.file, line, column.empty() ? fault.detail : column + ": " + fault.detail);
}

/// A fault of the request at the place in the files that it comes from.
InputFault in_files(const api::Fault& fault, const RosMapFile& map, const RobotTable& table) {
  const std::string_view pointer = fault.pointer;
  if (pointer.starts_with(kOfRobots)) return fault_of_robot(fault, table);
  if (!pointer.starts_with("/map")) return input_fault(table.file, 0, fault.detail);
  if (!pointer.starts_with(kOfImage)) return input_fault(map.yaml, 0, fault.detail);
  std::string_view member = pointer.substr(kOfImage.size());
  member = member.substr(0, member.find('/'));
  if (member == "pgm" || member == "png") return input_fault(map.image, 0, fault.detail);
  const auto line = map.lines.find(member);
  return input_fault(map.yaml, line == map.lines.end() ? 0 : line->second, fault.detail);
}

int refuse(const InputFault& fault, const Streams& streams) {
  streams.err << fault.line << '\n';
  return kBadInput;
}

int refuse(const api::RequestError& error, const RosMapFile& map, const RobotTable& table,
           const Streams& streams) {
  if (error.faults.empty()) return refuse(input_fault(map.yaml, 0, error.detail), streams);
  for (const api::Fault& fault : error.faults) refuse(in_files(fault, map, table), streams);
  if (error.faults_total > error.faults.size()) {
    streams.err << "and " << error.faults_total - error.faults.size() << " more faults\n";
  }
  return kBadInput;
}

}  // namespace

int map_to_request(const std::string& yaml, const std::string& robots, const std::string& output,
                   const Streams& streams) {
  const auto map = read_ros_map(yaml, streams.in);
  if (!map) return refuse(map.failure(), streams);
  const auto table = read_robot_table(robots, streams.in);
  if (!table) return refuse(table.failure(), streams);
  const std::string body = request_of(*map, *table);
  core::Work work(core::Work::Bounds{});
  const auto request = api::parse_request(body, {}, work);
  if (!request) return refuse(request.failure(), *map, *table, streams);
  for (const std::string& line : map->ignored) streams.err << line << '\n';
  for (const std::string& warning : request->warnings)
    streams.err << input_fault(robots, 0, warning).line << '\n';
  return write_output(output, body, streams);
}

}  // namespace fleetplan::server
