#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/bench/workload.h"

namespace fleetplan::bench {

/// A request that can be reduced to its first robots.
class Instance {
 public:
  /// `request` is a body of POST /v1/plan with an array of robots. `name` is the `file` of the results.
  Instance(std::string name, nlohmann::json request) : name_(std::move(name)), request_(std::move(request)) {}

  const std::string& name() const { return name_; }
  std::size_t robots() const { return request_.at("robots").size(); }

  /// The body with the first `robots` robots (at most all), with `options` and `defaults` of robots
  /// overriding its own.
  std::string body(std::size_t robots, const nlohmann::json& options,
                   const nlohmann::json& defaults = nlohmann::json::object()) const;

 private:
  std::string name_;
  nlohmann::json request_;
};

/// The request of a workload.
Instance make_instance(std::string name, const Workload& workload);

/// Reads a request file; throws std::runtime_error, naming the file, if it cannot be read or is not a
/// request.
Instance read_instance(std::string name, const std::filesystem::path& file);

}  // namespace fleetplan::bench
