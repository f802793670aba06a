#include "api/json/duplicate_keys.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/fault_text.h"
#include "api/json/location.h"
#include "core/runtime/stoppable_sort.h"

namespace fleetplan::api {

namespace {

// Up to here comparing all pairs is faster than sorting.
constexpr std::size_t kFewMembers = 16;

class DuplicateKeys {
 public:
  explicit DuplicateKeys(JsonDocument& document) : document_(document) {}

  void report() {
    for (std::uint32_t node = 0; node < document_.tape.size(); ++node) {
      if (document_.work->met_after(1)) return;
      const JsonValue value = document_.tape.value(node);
      if (value.is_object()) check(value);
    }
  }

 private:
  struct Member {
    std::uint32_t hash;  // of the key
    std::uint32_t node;  // of the value
  };

  std::string_view key(const Member& member) const { return document_.tape.value(member.node).key(); }

  void check(const JsonValue& object) {
    if (object.size() <= kFewMembers) return compare_all(object);
    std::vector<Member> members;
    members.reserve(object.size());
    for (const JsonValue value : object.children()) {
      if (document_.work->met_after(1)) return;
      const auto hash = static_cast<std::uint32_t>(std::hash<std::string_view>()(value.key()));
      members.push_back({hash, value.node()});
    }
    if (!sort(members)) return;
    for (std::size_t index = 1; index < members.size(); ++index) {
      if (document_.work->met_after(1)) return;
      if (members[index - 1].hash != members[index].hash) continue;
      if (key(members[index - 1]) == key(members[index])) add(document_.tape.value(members[index].node));
    }
  }

  void compare_all(const JsonValue& object) {
    for (const JsonValue value : object.children()) {
      const auto first = object.find(value.key());
      if (first != value) add(value);
    }
  }

  /// Sorts by key, and equal ones in the order of the document; false if it was stopped.
  bool sort(std::vector<Member>& members) {
    const auto before = [this](const Member& a, const Member& b) {
      if (a.hash != b.hash) return a.hash < b.hash;
      const int order = key(a).compare(key(b));
      return order != 0 ? order < 0 : a.node < b.node;
    };
    return core::stoppable_sort(members, before,
                                [this](std::size_t work) { return document_.work->met_after(work); });
  }

  void add(const JsonValue& later) {
    document_.faults.add(later.begins(), [&] {
      return Fault{locate(document_.root(), later).pointer, fault::kDuplicate,
                   "The key " + in_quotes(later.key()) + " occurs twice in this object; keep one of them."};
    });
  }

  JsonDocument& document_;
};

}  // namespace

void report_duplicate_keys(JsonDocument& document) { DuplicateKeys(document).report(); }

}  // namespace fleetplan::api
