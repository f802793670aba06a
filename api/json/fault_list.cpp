#include "api/json/fault_list.h"

#include <algorithm>
#include <utility>

namespace fleetplan::api {

namespace {

constexpr std::size_t kMostBytes = 1 << 20;  // a pointer can be as long as the keys in the document

}  // namespace

bool FaultList::wanted(JsonPlace place) const {
  const bool full = placed_.size() >= kMostListed || bytes_ >= kMostBytes;
  return !full || place < placed_.back().place;
}

void FaultList::keep(Placed placed) {
  bytes_ += placed.bytes();
  const auto after =
      std::upper_bound(placed_.begin(), placed_.end(), placed.place,
                       [](JsonPlace place, const Placed& other) { return place < other.place; });
  placed_.insert(after, std::move(placed));
  while (placed_.size() > kMostListed || bytes_ - placed_.back().bytes() >= kMostBytes) {
    bytes_ -= placed_.back().bytes();
    placed_.pop_back();
  }
}

std::vector<Fault> FaultList::listed() const {
  std::vector<Fault> faults;
  faults.reserve(placed_.size());
  for (const Placed& placed : placed_) faults.push_back(placed.fault);
  return faults;
}

}  // namespace fleetplan::api
