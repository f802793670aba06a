#include "core/verify/violations.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fleetplan::core {

void ViolationList::add(Violation violation) {
  ++total_;
  keep(std::move(violation));
}

void ViolationList::add(ViolationList more) {
  total_ += more.total_;
  for (Violation& violation : more.kept_) keep(std::move(violation));
}

std::vector<Violation> ViolationList::take() {
  sort_and_cut();
  total_ = 0;
  return std::exchange(kept_, {});
}

void ViolationList::keep(Violation violation) {
  kept_.push_back(std::move(violation));
  if (kept_.size() >= 2 * kMostViolations) sort_and_cut();
}

void ViolationList::sort_and_cut() {
  std::stable_sort(kept_.begin(), kept_.end(), [](const Violation& a, const Violation& b) {
    return std::tie(a.t, a.kind, a.robots, a.obstacle) < std::tie(b.t, b.kind, b.robots, b.obstacle);
  });
  if (kept_.size() > kMostViolations) {
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(kMostViolations), kept_.end());
  }
}

}  // namespace fleetplan::core
