#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "api/json/json_reader.h"

namespace fleetplan::api {

/// How many things of one kind a request may contain in total, wherever they are.
class Quota {
 public:
  /// `what`: in the plural, for the fault.
  Quota(std::size_t most, std::string_view what) : left_(most), most_(most), what_(what) {}

  /// Whether all items of the array are within the limit. Only the first array beyond it is a fault; then
  /// nothing more is.
  bool take(const JsonReader& array) { return take(array.size(), array); }
  /// The same for so many items that come from the value `place`.
  bool take(std::size_t count, const JsonReader& place) {
    if (exceeded_) return false;
    exceeded_ = count > left_;
    if (exceeded_) {
      place.fault(fault::kOutOfRange, "The request has more than " + std::to_string(most_) + " " +
                                          std::string(what_) + ", the maximum of this service; send fewer.");
      return false;
    }
    left_ -= count;
    return true;
  }

  /// So many more fit.
  std::size_t left() const { return exceeded_ ? 0 : left_; }

 private:
  std::size_t left_;
  std::size_t most_;
  std::string_view what_;
  bool exceeded_ = false;
};

}  // namespace fleetplan::api
