#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

#include "api/json/faults.h"
#include "api/json/json_reader.h"

namespace fleetplan::api {

/// Reports every id that an earlier robot or obstacle has.
class UniqueIds {
 public:
  enum class Kind { robot, obstacle };

  /// `item`: of the robot or obstacle with this index. All robots come before the obstacles.
  void check(Kind kind, const std::string& id, std::size_t index, const JsonReader& item) {
    if (id.empty()) return;
    const auto [first, is_new] = owner_.emplace(id, Owner{kind, index});
    if (is_new) return;
    item.find("id").fault(fault::kDuplicate, [&, earlier = first->second] {
      const std::string last = std::to_string(index);
      const std::string pair = earlier.kind == kind
                                   ? (kind == Kind::robot ? "Robots " : "Obstacles ") +
                                         std::to_string(earlier.index) + " and " + last
                                   : "Robot " + std::to_string(earlier.index) + " and obstacle " + last;
      return pair + " (from 0) both have the id " + in_quotes(id) + "; ids must be unique.";
    });
  }

 private:
  struct Owner {
    Kind kind;
    std::size_t index;
  };
  std::unordered_map<std::string, Owner> owner_;  // of each id, the first one that has it
};

}  // namespace fleetplan::api
