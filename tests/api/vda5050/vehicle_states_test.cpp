// State messages of vehicles are judged alone: what is odd costs its vehicle only, and is told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "tests/api/support/answers.h"
#include "tests/api/vda5050/reporting.h"

namespace fleetplan::api {
namespace TEST_FILE {

using testing::ElementsAre;

struct OddState {
  const char* patch;  // for the message of "a"
  Strings faults;
};

const std::vector<OddState> kOddStates{
    {R"({"orderId": null})", {"/messages/0/orderId missing"}},
    {R"({"orderId": 7})", {"/messages/0/orderId wrong_type"}},
    {R"({"orderUpdateId": null})", {"/messages/0/orderUpdateId missing"}},
    {R"({"orderUpdateId": "null"})", {"/messages/0/orderUpdateId wrong_type"}},
    {R"({"orderUpdateId": -1})", {"/messages/0/orderUpdateId out_of_range"}},
    {R"({"lastNodeSequenceId": null})", {"/messages/0/lastNodeSequenceId missing"}},
    {R"({"lastNodeSequenceId": "null"})", {"/messages/0/lastNodeSequenceId wrong_type"}},
    {R"({"lastNodeSequenceId": "NaN"})", {"/messages/0/lastNodeSequenceId wrong_type"}},
    {R"({"lastNodeSequenceId": 1, "nodeStates": null})", {"/messages/0/lastNodeSequenceId out_of_range"}},
    {R"({"lastNodeSequenceId": 4, "nodeStates": null})", {"/messages/0/lastNodeSequenceId out_of_range"}},
    {R"({"lastNodeSequenceId": 4000, "nodeStates": null})", {"/messages/0/lastNodeSequenceId out_of_range"}},
    {R"({"lastNodeId": 7})", {"/messages/0/lastNodeId wrong_type"}},
    {R"({"nodeStates": {}})", {"/messages/0/nodeStates wrong_type"}},
    {R"({"nodeStates": [7, {}]})",
     {"/messages/0/nodeStates/0 wrong_type", "/messages/0/nodeStates/1/sequenceId missing"}},
    {R"({"agvPosition": 7})", {"/messages/0/agvPosition wrong_type"}},
    {R"({"agvPosition": {"x": 1e10}})", {"/messages/0/agvPosition/x out_of_range"}},
    {R"({"agvPosition": {"x": "NaN", "theta": null}})",
     {"/messages/0/agvPosition/x wrong_type", "/messages/0/agvPosition/theta missing"}},
    {R"({"agvPosition": {"mapId": 1}})", {"/messages/0/agvPosition/mapId wrong_type"}},
    {R"({"operatingMode": 1})", {"/messages/0/operatingMode wrong_type"}},
    {R"({"paused": "no"})", {"/messages/0/paused wrong_type"}},
    {R"({"safetyState": []})", {"/messages/0/safetyState wrong_type"}},
    {R"({"actionStates": [{"actionStatus": "FINISHED"}]})", {"/messages/0/actionStates/0/actionId missing"}},
    {R"({"errors": [{}, 1]})",
     {"/messages/0/errors/0/errorLevel missing", "/messages/0/errors/1 wrong_type"}},
};

TEST(OddState, CostsItsVehicleOnly) {
  const Reporting hall;
  const Json usual = hall.imported(hall.messages);
  for (const OddState& odd : kOddStates) {
    SCOPED_TRACE(odd.patch);
    const Json patch = Json::parse(odd.patch);
    Json messages = hall.messages;
    messages[0] = patched(messages[0], patch);
    const Json answer = hall.imported(messages);
    EXPECT_EQ(told_of(answer, "b"), told_of(usual, "b"));
    Strings faults = faults_of_vehicle(of_robot(answer["vehicles"], "a"));
    std::sort(faults.begin(), faults.end());
    Strings expected = odd.faults;
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(faults, expected);
    EXPECT_EQ(reasons_of(of_robot(answer["vehicles"], "a"))[0], "unreadable");
    EXPECT_EQ(of_robot(answer["progress"], "a")["progress"], 0.0) << "it does not count";
    EXPECT_EQ(of_robot(answer["states"], "a")["released"], of_robot(usual["states"], "a")["released"]);
    EXPECT_TRUE(answer["errors"].empty());
  }
}

TEST(OddState, OfNobodyIsTold) {
  const Reporting hall;
  Json messages = Json::parse(R"([7, {"serialNumber": "c"}, {}, {"serialNumber": null}, []])");
  messages.push_back(hall.messages[0]);
  const Json answer = hall.imported(messages);
  EXPECT_EQ(faults_of_vehicle(answer),
            (Strings{"/messages/0 wrong_type", "/messages/1/serialNumber unknown_robot",
                     "/messages/2/serialNumber missing", "/messages/3/serialNumber wrong_type",
                     "/messages/4 wrong_type"}));
  EXPECT_EQ(told_of(answer, "a"), told_of(hall.imported(hall.messages), "a"));
  EXPECT_THAT(reasons_of(answer["vehicles"][1]), ElementsAre("not_reported"));
}

TEST(OddState, FaultsAreListedToAnEnd) {
  const Reporting hall;
  Json messages = hall.messages;
  messages[0]["errors"] = Json(5000, 7);
  messages.insert(messages.end(), 5000, Json(7));
  const Json answer = hall.imported(messages);
  EXPECT_EQ(answer["vehicles"][0]["errors"].size(), 20U);
  EXPECT_EQ(answer["vehicles"][0]["errors_total"], 5000);
  EXPECT_EQ(answer["errors"].size(), 20U);
  EXPECT_EQ(answer["errors_total"], 5000);
}

TEST(OddState, OfABaseDoesNotCount) {
  Reporting hall;
  hall.advance(3.0, hall.imported(hall.messages)["states"]);
  hall.begin();
  const Json usual = hall.exported();
  for (const char* state :
       {"7", "null", "[]", "{}", R"({"orderId": null})", R"({"lastNodeSequenceId": -1})",
        R"({"orderId": "a-2026-11-23T12:00:00.000Z", "lastNodeId": "a-0", "lastNodeSequenceId": "NaN"})"}) {
    SCOPED_TRACE(state);
    hall.body["base"][0]["state"] = Json::parse(state);
    EXPECT_EQ(hall.exported(), usual);
  }
}

TEST(SeveralStates, OfOneVehicleCountByTheirTime) {
  const Reporting hall;
  const Json newest = hall.messages[0];
  Json older = newest;
  older["agvPosition"]["x"] = 2.0;
  struct Case {
    const char* newer;
    const char* older;
  };
  for (const auto& [new_header, old_header] :
       {Case{R"({"timestamp": "2026-11-23T12:00:03.5Z"})", R"({"timestamp": "2026-11-23T12:00:03.25Z"})"},
        Case{R"({"timestamp": "2026-11-23T12:00:03.5Z", "headerId": 0})", R"({"headerId": 9})"},
        Case{R"({"headerId": 9})", R"({"headerId": 8})"},
        Case{R"({"timestamp": 7, "headerId": 9})", R"({"headerId": 8})"}}) {
    for (const bool is_first : {false, true}) {
      Json messages = {patched(older, Json::parse(old_header)), patched(newest, Json::parse(new_header))};
      if (is_first) std::swap(messages[0], messages[1]);
      const Json answer = hall.imported(messages);
      EXPECT_EQ(of_robot(answer["states"], "a")["x"], 4.0) << new_header << is_first;
      const std::string pointer = is_first ? "/messages/1 duplicate" : "/messages/0 duplicate";
      EXPECT_THAT(faults_of_vehicle(answer["vehicles"][0]), ElementsAre(pointer));
      EXPECT_TRUE(reasons_of(answer["vehicles"][0]).empty());
    }
  }
  // If nothing tells which is newer, the last message counts.
  older.erase("timestamp");
  older.erase("headerId");
  EXPECT_EQ(of_robot(hall.imported({newest, older})["states"], "a")["x"], 2.0);
}

TEST(State, MayHaveNullForWhatIsOptional) {
  const Reporting hall;
  for (const auto& item : hall.messages[0].items()) {
    const std::string& key = item.key();
    if (key == "serialNumber" || key == "orderId" || key == "orderUpdateId" || key == "lastNodeSequenceId")
      continue;
    SCOPED_TRACE(key);
    Json with_null = hall.messages;
    with_null[0][key] = nullptr;
    Json without = hall.messages;
    without[0].erase(key);
    const Json answer = hall.imported(with_null);
    EXPECT_EQ(answer, hall.imported(without));
    EXPECT_TRUE(reasons_of(answer["vehicles"][0]).empty());
  }
  Json inner = hall.messages;
  inner[0]["agvPosition"]["mapId"] = inner[0]["agvPosition"]["positionInitialized"] = nullptr;
  inner[0]["safetyState"] = {
      {"eStop", nullptr}, {"activeEmergencyStop", nullptr}, {"fieldViolation", nullptr}};
  inner[0]["errors"] = Json::parse(R"([{"errorLevel": "WARNING", "errorType": null, "errorReferences": null},
    {"errorLevel": "WARNING", "errorReferences": [{"referenceKey": null, "referenceValue": null}]}])");
  EXPECT_EQ(hall.imported(inner), hall.imported(hall.messages));
}

TEST(State, HasTheNumberOfItsLastNodeOnlyWithItsId) {
  Reporting hall;
  hall.messages[1]["nodeStates"] = nullptr;
  hall.messages[1]["lastNodeSequenceId"] = 4;
  EXPECT_TRUE(of_robot(hall.imported(hall.messages)["vehicles"], "b")["arrived"].get<bool>());
  for (const Json& id : {Json(""), Json()}) {
    for (const Json& number : {Json(4), Json(4000), Json(-1), Json("x"), Json()}) {
      hall.messages[1]["lastNodeId"] = id;
      hall.messages[1]["lastNodeSequenceId"] = number;
      const Json answer = hall.imported(hall.messages);
      EXPECT_FALSE(answer["vehicles"][1]["arrived"].get<bool>());
      EXPECT_EQ(answer["vehicles"][1]["errors"], Json::array());
      EXPECT_EQ(of_robot(answer["progress"], "b")["action"], 0);
      EXPECT_EQ(of_robot(answer["progress"], "b")["progress"], 0.0);
    }
  }
}

// ---------------------------------------------------------------- random states

/// Members with values as odd vehicles have them.
Json random_patch(std::mt19937& random) {
  static const Json kMembers = Json::parse(R"({
    "orderId": ["", "another", 7, "null", "a-2026-11-23T12:00:00.000Z"], "orderUpdateId": [-1, 0, 1, 1e300, "0", "null"],
    "lastNodeId": ["", "null", "n", []], "lastNodeSequenceId": [0, 2, 4, 6, 5, 4000, -1, 0.5, "NaN", "null"],
    "nodeStates": ["null", [], {}, [7], [{"sequenceId": 2}], [{"sequenceId": 4}], [{"sequenceId": -1}]],
    "edgeStates": ["null", [], 7], "driving": [true, false, "no", "null"], "paused": [true, 7],
    "operatingMode": ["MANUAL", "SERVICE", "STARTUP", "INTERVENED", "AUTOMATIC", "SEMIAUTOMATIC", 7, "null"],
    "safetyState": [7, {"eStop": 7}, {"eStop": "MANUAL"}, {"fieldViolation": true}, "null"],
    "agvPosition": ["null", [], {"x": 9, "y": 9}, {"x": 1e10, "y": 0, "theta": 0},
                    {"x": 8, "y": 5, "theta": 0, "mapId": "hall"}, {"x": 8, "y": 5, "theta": 0, "mapId": "attic"},
                    {"x": 9, "y": 9, "theta": 0, "localized": false}, {"x": "NaN", "positionInitialized": false}],
    "actionStates": ["null", {}, [7], [{}], [{"actionId": "a-2026-11-23T12:00:00.000Z-4-0", "actionStatus": "FAILED"}]],
    "errors": ["null", [7], [{}], [{"errorLevel": "FATAL"}],
               [{"errorLevel": "WARNING", "errorType": "orderError", "errorReferences": [7]}]],
    "serialNumber": ["a", "null", 7, "nobody"], "timestamp": [7, "null"], "headerId": [-1, "null"]})");
  Json patch = Json::object();
  const std::size_t count = 1 + random() % 4;
  for (std::size_t k = 0; k < count; ++k) {
    auto member = kMembers.begin();
    std::advance(member, random() % kMembers.size());
    const Json& values = member.value();
    patch[member.key()] = values[random() % values.size()];
  }
  return patch;
}

/// Whether a report of the order must not count, by the plainest words of the standard.
bool must_not_count(const Json& message, const Json& sent) {
  const auto text = [&](const char* key) {
    return message.value(key, Json()).is_string() ? message[key].get<std::string>() : "";
  };
  const std::string mode = text("operatingMode");
  if (Json(text("orderId")) != sent["orderId"] ||
      message.value("orderUpdateId", Json()) != sent["orderUpdateId"])
    return true;
  if (!mode.empty() && mode != "AUTOMATIC" && mode != "SEMIAUTOMATIC") return true;
  const Json position = message.value("agvPosition", Json());
  if (!position.is_object()) return text("lastNodeId").empty();
  return position.value("localized", true) == false || position.value("positionInitialized", true) == false ||
         position.value("mapId", "hall") != "hall";
}

TEST(RandomStates, CostTheirVehicleOnly) {
  constexpr int kStates = 500;
  const unsigned seed = 5050;
  std::mt19937 random(seed);
  const Reporting hall;
  const Json sent = hall.first[0]["order"];
  const Json usual = hall.imported(hall.messages);
  for (int k = 0; k < kStates; ++k) {
    const Json patch = random_patch(random);
    Json messages = hall.messages;
    messages[0] = patched(messages[0], patch);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", state " + std::to_string(k) + ": " + messages[0].dump());
    const Json answer = hall.imported(messages);
    ASSERT_EQ(told_of(answer, "b"), told_of(usual, "b"));
    const Json progress = of_robot(answer["progress"], "a");
    const bool is_as_before = progress["action"] == 0 && progress["progress"] == 0.0;
    const bool is_odd = answer["vehicles"][0]["errors_total"] > 0;
    ASSERT_TRUE(is_as_before || (!is_odd && !must_not_count(messages[0], sent)));
    // What was opened before stays open, and the next request is accepted.
    Reporting next = hall;
    next.body["progress"] = answer["progress"];
    const Json again = next.imported(hall.messages);
    ASSERT_EQ(told_of(again, "b"), told_of(usual, "b"));
    ASSERT_TRUE(next.exported()["orders"].empty()) << "\"b\" has not passed";
  }
}

}  // namespace TEST_FILE
}  // namespace fleetplan::api
