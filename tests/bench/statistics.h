#pragma once

// What is made of many numbers. Nothing is made of none.

#include <optional>
#include <vector>

namespace fleetplan::bench {

std::optional<double> minimum(const std::vector<double>& values);
std::optional<double> maximum(const std::vector<double>& values);
std::optional<double> mean(const std::vector<double>& values);
/// Of positive values.
std::optional<double> geometric_mean(const std::vector<double>& values);
/// The value below which a share (0 to 1) of the values lies, linear between neighbours: 0 is the smallest,
/// 1 the largest.
std::optional<double> percentile(std::vector<double> values, double share);
std::optional<double> median(std::vector<double> values);

}  // namespace fleetplan::bench
