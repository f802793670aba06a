#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/instance.h"
#include "tests/bench/options.h"
#include "tests/bench/result.h"

namespace fleetplan::bench {

/// An instance to measure with several numbers of robots; none: with all.
struct Job {
  std::string name;
  std::function<Instance()> load;  // may throw std::runtime_error
  std::vector<std::size_t> robots;
};

/// The name of a hall's workload, "empty/1", by which it can be made again.
std::string workload_name(const std::string& hall, std::uint64_t seed);
/// The instance that such a name means; none when it is no such name.
std::optional<Instance> named_workload(const std::string& name);

/// What the options ask for: the files named, or else the reference's, or else the paper's halls, seed by
/// seed. Throws std::runtime_error for files that do not exist.
std::vector<Job> jobs_of(const Options& options, const std::vector<Result>& reference);

}  // namespace fleetplan::bench
