#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "api/json/fault.h"

namespace fleetplan::api {

/// The faults of one document, collected while it is read and returned in the order of the document. Those
/// beyond a generous number are only counted, so that a hostile document cannot fill the memory.
class FaultList {
 public:
  /// Adds what `make_fault` returns, or only counts it. `place`: see JsonValue::begins().
  template <typename MakeFault>
  void add(std::uint32_t place, const MakeFault& make_fault) {
    ++count_;
    if (!full()) keep({place, make_fault()});
  }

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  /// The first `most` faults in the order of the document.
  std::vector<Fault> first(std::size_t most) const;

 private:
  struct Placed {
    std::uint32_t place = 0;
    Fault fault;
  };
  bool full() const;
  void keep(Placed placed);

  std::vector<Placed> placed_;
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;  // of the texts in placed_
};

}  // namespace fleetplan::api
