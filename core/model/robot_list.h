#pragma once

#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

namespace fleetplan::core {

/// Robots by index: the first few of a list that may contain all of them, and how many it contains. So lists
/// for every robot are not quadratic in the robots.
class RobotList {
 public:
  static constexpr std::size_t kMostListed = 20;

  using value_type = std::size_t;
  using const_iterator = std::vector<std::size_t>::const_iterator;

  RobotList() = default;
  RobotList(std::initializer_list<std::size_t> all) : RobotList(std::vector<std::size_t>(all)) {}
  RobotList(std::vector<std::size_t> all)  // NOLINT: implicit
      : total_(all.size()) {
    if (all.size() > kMostListed) all = std::vector<std::size_t>(all.begin(), all.begin() + kMostListed);
    listed_ = std::move(all);
  }

  const_iterator begin() const { return listed_.begin(); }
  const_iterator end() const { return listed_.end(); }
  std::size_t operator[](std::size_t index) const { return listed_[index]; }
  std::size_t size() const { return listed_.size(); }
  bool empty() const { return listed_.empty(); }
  /// Of the whole list.
  std::size_t total() const { return total_; }
  bool operator==(const RobotList&) const = default;

 private:
  std::vector<std::size_t> listed_;
  std::size_t total_ = 0;
};

}  // namespace fleetplan::core
