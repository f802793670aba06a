
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "api/json/errors.h"
#include "api/json/json_writer.h"
#include "api/request/limits.h"
#include "server/command/commands.h"

namespace fleetplan::server {

namespace {

/// The most bytes of a map.yaml, which has some hundred. Aliases are not expanded, and yaml-cpp limits the
/// depth.
constexpr std::size_t kMaxYaml = std::size_t{64} << 10;
/// The most bytes of an image: a request with it in base64 is below the default limit of a server, with room
/// for robots.
constexpr std::size_t kMaxImage = (api::Limits{}.max_body - (std::size_t{2} << 20)) / 4 * 3;
constexpr std::size_t kOriginLength = 3;

constexpr std::array<std::string_view, 7> kMembers{
    "image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"};
constexpr std::array<std::string_view, 3> kModes{"trinary", "scale", "raw"};

std::size_t line_of(const YAML::Mark& mark) { return static_cast<std::size_t>(mark.line) + 1; }

/// Reads a number as map_server does, quoted or not.
std::optional<double> number_of(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  return read_number(node.Scalar());
}

std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return api::in_quotes(node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
    default:
      return "nothing";
  }
}

std::string base64_of(std::string_view bytes) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t byte = 0; byte < 3; ++byte) {
      bits = bits << 8U | (at + byte < bytes.size() ? static_cast<unsigned char>(bytes[at + byte]) : 0U);
    }
    for (std::size_t letter = 0; letter < 4; ++letter) {
      const bool is_padding = at + letter > bytes.size();
      text += is_padding ? '=' : kAlphabet[bits >> (18U - 6U * letter) & 63U];
    }
  }
  return text;
}

/// Reads the members of a document in the order of the table above.
class MapReader {
 public:
  MapReader(std::string yaml, const YAML::Node& document) : document_(document) {
    map_.yaml = std::move(yaml);
  }

  api::Result<RosMapFile, InputFault> read() {
    if (!document_.IsMap()) {
      return input_fault(
          map_.yaml, 1, "a map.yaml has lines such as \"image: map.pgm\"; this is " + shown(document_) + ".");
    }
    list_members();
    read_image_name();
    read_mode();
    read_number("resolution", true);
    read_origin();
    read_negate();
    read_number("occupied_thresh", false);
    read_number("free_thresh", false);
    if (!fault_) read_image();
    if (fault_) return *fault_;
    map_.json = json_.end_object().take();
    return std::move(map_);
  }

 private:
  void fail(const YAML::Node& at, const std::string& detail) { fail(line_of(at.Mark()), detail); }
  void fail(std::size_t line, const std::string& detail) {
    if (!fault_) fault_ = input_fault(map_.yaml, line, detail);
  }

  void list_members() {
    for (const auto& member : document_) {
      const std::size_t line = line_of(member.first.Mark());
      const std::string key = member.first.IsScalar() ? member.first.Scalar() : "";
      if (std::find(kMembers.begin(), kMembers.end(), key) == kMembers.end()) {
        map_.ignored.push_back(
            input_fault(map_.yaml, line,
                        api::in_quotes(key) + " is ignored" + api::suggestion(key, kMembers) + '.')
                .line);
      } else if (!map_.lines.emplace(key, line).second) {
        fail(line, key + " is there a second time; remove one of them.");
      } else {
        members_.emplace_back(key, member.second);
      }
    }
    json_.begin_object();
  }

  /// Returns the value of a member; null if it is not there, or there is a fault.
  const YAML::Node* find(std::string_view key, std::string_view remedy = "") {
    if (fault_) return nullptr;
    for (const auto& [name, value] : members_) {
      if (name == key) return &value;
    }
    if (!remedy.empty())
      fail(0, std::string(key) + " is missing; add a line such as \"" + std::string(remedy) + "\".");
    return nullptr;
  }

  void read_image_name() {
    const YAML::Node* image = find("image", "image: map.pgm");
    if (image == nullptr) return;
    if (!image->IsScalar() || image->Scalar().empty()) {
      return fail(*image, "image must be the name of the file, not " + shown(*image) + '.');
    }
    const std::filesystem::path beside = std::filesystem::path(map_.yaml).parent_path();
    map_.image = beside / image->Scalar();  // an absolute path stays as it is
    json_.member("image", std::string_view(image->Scalar()));
  }

  void read_mode() {
    const YAML::Node* mode = find("mode");
    if (mode == nullptr) return;
    const std::string word = mode->IsScalar() ? mode->Scalar() : "";
    if (std::find(kModes.begin(), kModes.end(), word) == kModes.end()) {
      return fail(*mode, "mode must be " + api::alternatives(kModes) + ", not " + shown(*mode) + '.');
    }
    json_.member("mode", std::string_view(word));
  }

  void read_number(std::string_view key, bool is_required) {
    const YAML::Node* member = find(key, is_required ? "resolution: 0.05" : "");
    if (member == nullptr) return;
    const auto number = number_of(*member);
    if (!number) return fail(*member, std::string(key) + " must be a number, not " + shown(*member) + '.');
    json_.member(key, *number);
  }

  void read_origin() {
    const YAML::Node* origin = find("origin", "origin: [0.0, 0.0, 0.0]");
    if (origin == nullptr) return;
    const std::string wanted = "origin must be a list of three numbers, [x, y, yaw] of the lower left pixel";
    if (!origin->IsSequence()) return fail(*origin, wanted + ", not " + shown(*origin) + '.');
    if (origin->size() != kOriginLength) {
      return fail(*origin, wanted + "; it has " + std::to_string(origin->size()) + '.');
    }
    json_.key("origin").begin_array();
    for (const YAML::Node& item : *origin) {
      const auto number = number_of(item);
      if (!number) return fail(item, wanted + ", not " + shown(item) + '.');
      json_.value(*number);
    }
    json_.end_array();
  }

  /// Reads `negate`. map_server accepts numbers and booleans.
  void read_negate() {
    const YAML::Node* negate = find("negate");
    if (negate == nullptr) return;
    const auto number = number_of(*negate);
    bool value = number == 1.0;
    const bool is_read =
        number == 0.0 || value || (negate->IsScalar() && YAML::convert<bool>::decode(*negate, value));
    if (!is_read) return fail(*negate, "negate must be 0, 1, false or true, not " + shown(*negate) + '.');
    json_.member("negate", value);
  }

  void read_image() {
    const std::size_t line = map_.lines["image"];
    std::ifstream none;
    const auto bytes = read_file(map_.image, none, kMaxImage);
    if (!bytes) {
      const bool is_large = bytes.failure().line.find("more than") != std::string::npos;
      return fail(line, "the image cannot be used: " + bytes.failure().line +
                            (is_large ? " Convert it to PNG, which is much smaller." : ""));
    }
    if (bytes->starts_with("P2") || bytes->starts_with("P5")) {
      json_.member("pgm", std::string_view(base64_of(*bytes)));
    } else if (bytes->starts_with("\x89PNG")) {
      json_.member("png", std::string_view(base64_of(*bytes)));
    } else {
      fail(line, map_.image + " is neither a PGM (P2 or P5) nor a PNG; convert it to PNG.");
    }
  }

  const YAML::Node document_;
  std::vector<std::pair<std::string, YAML::Node>> members_;
  RosMapFile map_;
  api::JsonWriter json_;
  std::optional<InputFault> fault_;
};

}  // namespace

api::Result<RosMapFile, InputFault> read_ros_map(const std::string& yaml, std::istream& in) {
  const auto text = read_file(yaml, in, kMaxYaml);
  if (!text) return text.failure();
  if (text->find('\0') != std::string::npos || text->starts_with("P5") || text->starts_with("\x89PNG")) {
    return input_fault(yaml, 0, "this is not a map.yaml; give the file that names the image.");
  }
  try {
    return MapReader(yaml, YAML::Load(*text)).read();
  } catch (const YAML::Exception& error) {  // how yaml-cpp reports faults of a text
    return input_fault(yaml, line_of(error.mark), "this is not YAML: " + error.msg + '.');
  }
}

}  // namespace fleetplan::server
