#include "api/json/fault_list.h"

#include <algorithm>

namespace fleetplan::api {

namespace {

constexpr std::size_t kMostKept = 10'000;    // many more than an answer lists
constexpr std::size_t kMostBytes = 4 << 20;  // a pointer can be as long as the keys in the document

}  // namespace

bool FaultList::full() const { return placed_.size() >= kMostKept || bytes_ >= kMostBytes; }

void FaultList::keep(Placed placed) {
  bytes_ += placed.fault.pointer.size() + placed.fault.detail.size();
  placed_.push_back(std::move(placed));
}

std::vector<Fault> FaultList::first(std::size_t most) const {
  std::vector<const Placed*> order;
  order.reserve(placed_.size());
  for (const Placed& placed : placed_) order.push_back(&placed);
  std::stable_sort(order.begin(), order.end(),
                   [](const Placed* left, const Placed* right) { return left->place < right->place; });
  std::vector<Fault> faults;
  for (std::size_t index = 0; index < std::min(most, order.size()); ++index) {
    faults.push_back(order[index]->fault);
  }
  return faults;
}

}  // namespace fleetplan::api
