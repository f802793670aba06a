#include <algorithm>
#include <string>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/json/json_reader.h"
#include "api/json/json_writer.h"
#include "api/request/limits.h"
#include "api/request/map/parse_map.h"

namespace fleetplan::api {

namespace {

/// A line of the list of examples.
struct Entry {
  const Example* example;
  std::string title;
  std::string description;
};

/// Reads an embedded file, which the tests check. Its root is null if it is not JSON.
JsonDocument read_embedded(std::string_view text, core::Work& work) {
  auto document = read_json(text, Limits{}.max_depth, work);
  return document ? std::move(*document) : std::move(*read_json("null", 1, work));
}

std::string string_member(const JsonValue& object, std::string_view key) {
  const auto member = object.find(key);
  return std::string(member ? member->string().value_or("") : "");
}

std::size_t size_of(const std::optional<JsonValue>& value) { return value ? value->size() : 0; }

const Example* find_example(std::string_view name) {
  const auto all = examples();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Example& example) { return example.name == name; });
  return found != all.end() ? &*found : nullptr;
}

/// Returns all examples: first the examples of the index, in its order, then the rest.
std::vector<Entry> entries(core::Work& work) {
  std::vector<Entry> listed;
  const JsonDocument index = read_embedded(examples_index(), work);
  for (const JsonValue item : index.root().children()) {
    const Example* example = find_example(string_member(item, "name"));
    if (example == nullptr) continue;
    listed.push_back({example, string_member(item, "title"), string_member(item, "description")});
  }
  for (const Example& example : examples()) {
    const bool known = std::any_of(listed.begin(), listed.end(),
                                   [&](const Entry& entry) { return entry.example == &example; });
    if (!known) listed.push_back({&example, std::string(example.name), ""});
  }
  return listed;
}

}  // namespace

Reply examples_endpoint() {
  core::Work work = core::Work::unbounded();  // the examples are part of the program
  JsonWriter json;
  json.begin_object().key("examples").begin_array();
  for (const Entry& entry : entries(work)) {
    JsonDocument document = read_embedded(entry.example->body, work);
    const JsonValue request = document.root();
    const auto map = parse_map(JsonReader(document).find("map"), Limits{}.max_cells);
    json.begin_object();
    json.member("name", entry.example->name).member("title", entry.title);
    json.member("description", entry.description).member("robots", size_of(request.find("robots")));
    json.member("columns", map ? map->grid.columns() : 0).member("rows", map ? map->grid.rows() : 0);
    json.end_object();
  }
  json.end_array().end_object();
  return {200, kJson, json.take()};
}

}  // namespace fleetplan::api
