#pragma once

#include <cstddef>
#include <vector>

#include "api/json/fault.h"
#include "api/json/json_value.h"

namespace fleetplan::api {

/// The faults of one document, collected while it is read. All are counted, and the first kMostListed in the
/// order of the document are kept; of the others not even the text is made, so that a hostile document costs
/// neither time nor memory.
class FaultList {
 public:
  static constexpr std::size_t kMostListed = 20;

  /// Adds what `make_fault` returns, or only counts it.
  template <typename MakeFault>
  void add(JsonPlace place, const MakeFault& make_fault) {
    ++count_;
    if (wanted(place)) keep({place, make_fault()});
  }
  /// Counts faults that were found, but not described.
  void count_more(std::size_t faults) { count_ += faults; }

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  std::vector<Fault> listed() const;

 private:
  struct Placed {
    JsonPlace place = 0;
    Fault fault;
    std::size_t bytes() const { return fault.pointer.size() + fault.detail.size(); }
  };
  bool wanted(JsonPlace place) const;
  void keep(Placed placed);

  std::vector<Placed> placed_;  // in the order of the document
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;  // of the texts in placed_
};

}  // namespace fleetplan::api
