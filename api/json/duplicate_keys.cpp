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

namespace fleetplan::api {

namespace {

// Up to here comparing all pairs is faster than sorting.
constexpr std::size_t kFewMembers = 16;
// So many members are sorted or merged between two looks at the stop.
constexpr std::size_t kChunk = 4096;

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

  /// Sorts by key, and equal ones in the order of the document. Merges chunks, as std::sort cannot be
  /// stopped; false if it was.
  bool sort(std::vector<Member>& members) {
    const auto before = [this](const Member& a, const Member& b) {
      if (a.hash != b.hash) return a.hash < b.hash;
      const int order = key(a).compare(key(b));
      return order != 0 ? order < 0 : a.node < b.node;
    };
    const auto at = [&](std::size_t index) {
      return members.begin() + static_cast<std::ptrdiff_t>(std::min(index, members.size()));
    };
    // Bounded: met_after() ends it.
    for (std::size_t begin = 0; begin < members.size(); begin += kChunk) {
      if (document_.work->met_after(kChunk)) return false;
      std::sort(at(begin), at(begin + kChunk), before);
    }
    for (std::size_t width = kChunk; width < members.size(); width *= 2) {
      for (std::size_t begin = 0; begin < members.size(); begin += 2 * width) {
        if (document_.work->met_after(2 * width)) return false;
        std::inplace_merge(at(begin), at(begin + width), at(begin + 2 * width), before);
      }
    }
    return true;
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
