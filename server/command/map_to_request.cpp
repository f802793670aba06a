#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/json/errors.h"
#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/request/parse_request.h"
#include "server/command/commands.h"

namespace fleetplan::server {

namespace {

/// A table of robots as CSV.
struct RobotTable {
  std::string file;                // name of the file
  std::string json;                // the member `robots` of a request
  std::vector<std::size_t> lines;  // line in the file, from 1, by robot
};

/// The most bytes of a table. Two thousand robots, which a server accepts by default, have 200 kB.
constexpr std::size_t kMaxTable = std::size_t{4} << 20;

struct Column {
  std::string_view name;
  std::string_view short_name;
  std::string_view pose;    // member of the robot that has it; empty: the robot itself
  std::string_view member;  // its name in that member
  bool is_required = false;
};

constexpr std::array<Column, 11> kColumns{{
    {"id", "name", "", "id", true},
    {"radius", "radius", "", "radius", true},
    {"linear_speed", "speed", "", "linear_speed", true},
    {"angular_speed", "angular_speed", "", "angular_speed", true},
    {"vicinity", "vicinity", "", "vicinity", false},
    {"start_x", "start_x", "start", "x", true},
    {"start_y", "start_y", "start", "y", true},
    {"start_theta", "start_theta", "start", "theta", false},
    {"goal_x", "goal_x", "goal", "x", false},
    {"goal_y", "goal_y", "goal", "y", false},
    {"goal_theta", "goal_theta", "goal", "theta", false},
}};

std::string column_names() {
  std::string names;
  for (const Column& column : kColumns) names += (names.empty() ? "" : ", ") + std::string(column.name);
  return names;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

/// Whether a line is UTF-8 without control characters other than tabs.
bool is_text(std::string_view line) {
  constexpr std::string_view kNotPlain = "\"\\\t";  // what a string of JSON escapes
  for (std::size_t at = 0; at < line.size(); ++at) {
    at += api::plain_length(line.substr(at));
    if (at < line.size() && kNotPlain.find(line[at]) == std::string_view::npos) return false;
  }
  return true;
}

/// Returns the fields of a line; none if a quote is not closed, or something follows it.
std::optional<std::vector<std::string>> fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields;
  while (true) {
    const std::string_view rest = trimmed(line);
    std::string field;
    std::size_t end = 0;
    if (rest.starts_with('"')) {
      std::size_t at = static_cast<std::size_t>(rest.data() - line.data()) + 1;
      for (; at < line.size() && !(line[at] == '"' && line.substr(at, 2) != "\"\""); ++at) {
        field += line[at];
        if (line[at] == '"') ++at;
      }
      if (at >= line.size()) return std::nullopt;
      end = std::min(line.find(separator, at), line.size());
      if (!trimmed(line.substr(at + 1, end - at - 1)).empty()) return std::nullopt;
    } else {
      end = std::min(line.find(separator), line.size());
      field = trimmed(line.substr(0, end));
    }
    fields.push_back(std::move(field));
    if (end == line.size()) return fields;
    line.remove_prefix(end + 1);
  }
}

class TableReader {
 public:
  explicit TableReader(std::string file) { table_.file = std::move(file); }

  api::Result<RobotTable, InputFault> read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // as spreadsheets write it
    json_.begin_array();
    while (!text.empty() && !fault_) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!fault_ && columns_.empty())
      fail("there is no header line; it names columns: " + column_names() + '.', 0);
    if (fault_) return *fault_;
    table_.json = json_.end_array().take();
    return std::move(table_);
  }

 private:
  void fail(const std::string& detail) { fail(detail, line_); }
  void fail(const std::string& detail, std::size_t line) {
    if (!fault_) fault_ = input_fault(table_.file, line, detail);
  }

  void read_line(std::string_view line) {
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) return;
    if (!is_text(trimmed(line))) {
      return fail("the line is not text in UTF-8; save the file as CSV in UTF-8.");
    }
    if (columns_.empty()) choose_separator(line);
    const auto fields = fields_of(line, separator_);
    if (!fields)
      return fail("a quote is not closed, or something follows it; write \"\" for a quote in quotes.");
    if (columns_.empty()) {
      read_header(*fields);
    } else {
      read_robot(*fields);
    }
  }

  void choose_separator(std::string_view header) {
    const std::size_t at = header.find_first_of(",;\t");
    if (at != std::string_view::npos) separator_ = header[at];
  }

  void read_header(const std::vector<std::string>& names) {
    std::array<std::string_view, kColumns.size()> known;
    std::transform(kColumns.begin(), kColumns.end(), known.begin(),
                   [](const Column& column) { return column.name; });
    for (const std::string& name : names) {
      const auto found = std::find_if(kColumns.begin(), kColumns.end(), [&](const Column& column) {
        return column.name == name || column.short_name == name;
      });
      if (found == kColumns.end()) {
        return fail("unknown column " + api::in_quotes(name) + api::suggestion(name, known) +
                    "; known columns: " + column_names() + '.');
      }
      if (std::find(columns_.begin(), columns_.end(), &*found) != columns_.end()) {
        return fail("the column " + std::string(found->name) + " is there twice; remove one of them.");
      }
      columns_.push_back(&*found);
    }
    for (const Column& column : kColumns) {
      if (column.is_required && std::find(columns_.begin(), columns_.end(), &column) == columns_.end()) {
        return fail("the column " + std::string(column.name) +
                    " is missing; add it to this header and to each line.");
      }
    }
  }

  void read_robot(const std::vector<std::string>& fields) {
    if (fields.size() != columns_.size()) {
      return fail("the line has " + std::to_string(fields.size()) + " fields, but the header has " +
                  std::to_string(columns_.size()) + "; write numbers with a point, and leave no field out.");
    }
    table_.lines.push_back(line_);
    json_.begin_object();
    write_members(fields, "");
    for (const std::string_view pose : {"start", "goal"}) {
      if (!has_any(fields, pose)) continue;
      json_.key(pose).begin_object();
      write_members(fields, pose);
      json_.end_object();
    }
    json_.end_object();
  }

  bool has_any(const std::vector<std::string>& fields, std::string_view pose) const {
    for (std::size_t index = 0; index < fields.size(); ++index) {
      if (columns_[index]->pose == pose && !fields[index].empty()) return true;
    }
    return false;
  }

  void write_members(const std::vector<std::string>& fields, std::string_view pose) {
    for (std::size_t index = 0; index < fields.size(); ++index) {
      const Column& column = *columns_[index];
      const std::string& field = fields[index];
      if (column.pose != pose) continue;
      if (field.empty()) {
        if (column.is_required) fail(std::string(column.name) + " is empty; give it for each robot.");
      } else if (column.member == "id") {
        json_.member(column.member, std::string_view(field));
      } else if (const auto number = read_number(field)) {
        json_.member(column.member, *number);
      } else {
        const bool has_comma = field.find(',') != std::string::npos;
        fail(std::string(column.name) + " must be a number, not " + api::in_quotes(field) +
             (has_comma ? "; write a point instead of the comma." : "."));
      }
    }
  }

  RobotTable table_;
  char separator_ = ',';
  std::size_t line_ = 0;
  std::vector<const Column*> columns_;  // in the order of the file
  api::JsonWriter json_;
  std::optional<InputFault> fault_;
};

/// Reads a table with a header line (docs/command_line.md has the columns): RFC 4180 without line breaks in
/// fields, with commas, semicolons or tabs. Fields that are empty are left out of the request.
api::Result<RobotTable, InputFault> read_robot_table(const std::string& file, std::istream& in) {
  const auto text = read_file(file, in, kMaxTable);
  if (!text) return text.failure();
  return TableReader(file).read(*text);
}

constexpr std::string_view kOfImage = "/map/image/";
constexpr std::string_view kOfRobots = "/robots/";

std::string request_of(const RosMapFile& map, const RobotTable& table) {
  api::JsonWriter json;
  json.begin_object().key("map").begin_object().key("image").json(map.json).end_object();
  json.key("robots").json(table.json).end_object();
  return json.take() + '\n';
}

/// Returns a fault of the map at the place in the files that it comes from.
InputFault in_map(const api::Fault& fault, const RosMapFile& map) {
  const std::string_view pointer = fault.pointer;
  if (!pointer.starts_with(kOfImage)) return input_fault(map.yaml, 0, fault.detail);
  std::string_view member = pointer.substr(kOfImage.size());
  member = member.substr(0, member.find('/'));
  if (member == "pgm" || member == "png") return input_fault(map.image, 0, fault.detail);
  const auto line = map.lines.find(member);
  return input_fault(map.yaml, line == map.lines.end() ? 0 : line->second, fault.detail);
}

/// Returns the fault of a robot with its line and, if it is one, its column.
InputFault in_robots(const api::Fault& fault, const RequestFiles& files) {
  const std::string_view steps = std::string_view(fault.pointer).substr(kOfRobots.size());
  std::size_t robot = 0;
  const auto [end, error] = std::from_chars(steps.data(), steps.data() + steps.size(), robot);
  const auto& lines = files.robot_lines;
  const std::size_t line = error == std::errc() && robot < lines.size() ? lines[robot] : 0;
  std::string column(end, steps.data() + steps.size());
  if (!column.empty()) column.erase(0, 1);
  std::replace(column.begin(), column.end(), '/', '_');
  return input_fault(files.robots, line, column.empty() ? fault.detail : column + ": " + fault.detail);
}

InputFault in_files(const api::Fault& fault, const RequestFiles& files) {
  const std::string_view pointer = fault.pointer;
  if (pointer.starts_with(kOfRobots)) return in_robots(fault, files);
  if (!pointer.starts_with("/map")) return input_fault(files.robots, 0, fault.detail);
  return files.in_map ? files.in_map(fault) : input_fault(files.map, 0, fault.detail);
}

int refuse(const api::RequestError& error, const RequestFiles& files, const Streams& streams) {
  if (error.faults.empty()) return refuse(input_fault(files.map, 0, error.detail), streams);
  for (const api::Fault& fault : error.faults) refuse(in_files(fault, files), streams);
  if (error.faults_total > error.faults.size()) {
    streams.err << "and " << error.faults_total - error.faults.size() << " more faults\n";
  }
  return kBadInput;
}

}  // namespace

int write_request(const std::string& body, const RequestFiles& files, const std::string& output,
                  const api::Limits& limits, const Streams& streams) {
  core::Work work(core::Work::Bounds{});
  const auto request = api::parse_request(body, limits, work);
  if (!request) return refuse(request.failure(), files, streams);
  for (const std::string& line : files.notes) streams.err << line << '\n';
  for (const std::string& warning : request->warnings) {
    const bool is_of_map = warning.find("map.image") != std::string::npos;
    streams.err << input_fault(is_of_map ? files.map : files.robots, 0, warning).line << '\n';
  }
  return write_output(output, body, streams);
}

int map_to_request(const std::string& yaml, const std::string& robots, const std::string& output,
                   const api::Limits& limits, const Streams& streams) {
  const auto map = read_ros_map(yaml, streams.in);
  if (!map) return refuse(map.failure(), streams);
  const auto table = read_robot_table(robots, streams.in);
  if (!table) return refuse(table.failure(), streams);
  const auto place = [&](const api::Fault& fault) { return in_map(fault, *map); };
  const RequestFiles files{yaml, robots, table->lines, place, map->ignored};
  return write_request(request_of(*map, *table), files, output, limits, streams);
}

}  // namespace fleetplan::server
