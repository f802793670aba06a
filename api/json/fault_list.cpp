#include "api/json/fault_list.h"

#include <algorithm>
#include <utility>

namespace fleetplan::api {

namespace {

// Enough to answer with the first hundred in order; a hostile body must not make us hoard millions.
constexpr std::size_t kMostKept = 10'000;
constexpr std::size_t kMostBytes = 4 << 20;  // a pointer may be as long as the keys in the body

}  // namespace

bool FaultList::full() const { return placed_.size() >= kMostKept || bytes_ >= kMostBytes; }

void FaultList::add(const JsonValue& value, const JsonPath& path, const char* code, std::string detail) {
  add(value.begins(), full() ? Fault{} : Fault{path.pointer(), code, std::move(detail)});
}

void FaultList::add_missing(const JsonValue& object, const JsonPath& member, std::string detail) {
  add(object.ends(), full() ? Fault{} : Fault{member.pointer(), fault::kMissing, std::move(detail)});
}

void FaultList::add(std::uint32_t place, Fault fault) {
  ++count_;
  if (full()) return;
  bytes_ += fault.pointer.size() + fault.detail.size();
  placed_.push_back({place, std::move(fault)});
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
