#pragma once

// Streams of events as a client reads them.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fleetplan::server {

struct Event {
  std::string name;
  nlohmann::json data;
};

/// The events of a whole stream; each has to be its `event:` line, one `data:` line and an empty line.
inline std::vector<Event> events_of(const std::string& stream) {
  std::vector<Event> events;
  std::size_t position = 0;
  const auto line = [&](const std::string& begin) {
    const std::size_t end = stream.find('\n', position);
    EXPECT_EQ(stream.substr(position, begin.size()), begin) << "at byte " << position;
    EXPECT_NE(end, std::string::npos) << "at byte " << position;
    std::string rest = stream.substr(position + begin.size(), end - position - begin.size());
    position = end == std::string::npos ? stream.size() : end + 1;
    return rest;
  };
  while (position < stream.size() && !testing::Test::HasFailure()) {
    Event event{line("event: "), nlohmann::json::parse(line("data: "), nullptr, false)};
    EXPECT_FALSE(event.data.is_discarded()) << event.name;
    EXPECT_EQ(line(""), "");
    events.push_back(std::move(event));
  }
  return events;
}

inline std::vector<nlohmann::json> data_of(const std::vector<Event>& events, const std::string& name) {
  std::vector<nlohmann::json> data;
  for (const Event& event : events) {
    if (event.name == name) data.push_back(event.data);
  }
  return data;
}

}  // namespace fleetplan::server
