#include "api/request/map/image/image_reader.h"

#include <string>

namespace fleetplan::api {

std::optional<ImageFault> size_fault(std::uint64_t columns, std::uint64_t rows, std::int64_t most) {
  const std::string size = std::to_string(columns) + " x " + std::to_string(rows);
  if (columns > kLongestSide || rows > kLongestSide) {
    return ImageFault{"Its " + size + " pixels are too many; it must be at most " +
                          std::to_string(kLongestSide) + " pixels wide and high.",
                      true};
  }
  if (columns * rows <= static_cast<std::uint64_t>(most)) return std::nullopt;
  return ImageFault{"It has " + size + " = " + std::to_string(columns * rows) +
                        " pixels; this service accepts at most " + std::to_string(most) +
                        ". Use a coarser resolution or a part of the map.",
                    true};
}

}  // namespace fleetplan::api
