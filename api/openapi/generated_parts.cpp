#include "api/openapi/generated_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/endpoints/endpoints.h"
#include "api/json/errors.h"
#include "api/request/options.h"
#include "api/response/reply.h"

namespace fleetplan::api {

namespace {

using Json = nlohmann::ordered_json;

const ParsedOptions kDefaults;

/// Returns a number as JSON; whole numbers have no decimal point.
Json number(double value) {
  constexpr double kLargestWhole = 1e15;
  if (std::abs(value) > kLargestWhole || std::floor(value) != value) return value;
  return static_cast<std::int64_t>(value);
}

Json with_range(Json schema, const Range& range) {
  schema["minimum"] = number(range.least);
  schema["maximum"] = number(range.max);
  return schema;
}

Json schema_of(const RealOption& option) {
  Json schema = with_range({{"type", "number"}}, option.range);
  schema["default"] = number(kDefaults.plan.*option.field);
  return schema;
}

Json schema_of(const ChosenOption& option) {
  Json schema = with_range({{"type", Json::array({"number", "null"})}}, option.range);
  schema["default"] = nullptr;
  return schema;
}

Json schema_of(const ServiceOption& option) {
  Json schema = with_range({{"type", "number"}}, option.range);
  schema["examples"] = Json::array({number(option.example)});
  return schema;
}

Json schema_of(const NaturalOption& option) {
  return {{"type", "integer"},
          {"minimum", 0},
          {"maximum", option.max},
          {"default", kDefaults.plan.*option.field}};
}

Json schema_of(const BoundOption& option) {
  return {{"type", Json::array({"integer", "null"})},
          {"minimum", 0},
          {"maximum", option.max},
          {"default", nullptr}};
}

Json schema_of(const CountOption& option) {
  return {{"type", "integer"}, {"enum", option.values}, {"default", kDefaults.plan.*option.field}};
}

Json schema_of(const BooleanOption& option) {
  return {{"type", "boolean"}, {"default", kDefaults.plan.*option.field}};
}

Json schema_of(const AnswerRealOption& option) {
  Json schema = with_range({{"type", "number"}}, option.range);
  schema["default"] = number(kDefaults.*option.field);
  return schema;
}

Json schema_of(const AnswerBooleanOption& option) {
  return {{"type", "boolean"}, {"default", kDefaults.*option.field}};
}

Json schema_of(const WordOption& option) {
  Json names = Json::array();
  Json meanings;
  for (const WordOption::Word& word : option.words) {
    names.push_back(word.name);
    meanings[std::string(word.name)] = word.meaning;
  }
  const auto standard = option.words[option.get(kDefaults)].name;
  return {{"type", "string"}, {"enum", names}, {"x-enumDescriptions", meanings}, {"default", standard}};
}

Json schema_of(const OptionRow& row) {
  Json schema{{"title", row.title}, {"description", row.description}};
  if (!row.unit.empty()) schema["x-unit"] = row.unit;
  schema.update(std::visit([](const auto& type) { return schema_of(type); }, row.type));
  return schema;
}

/// Returns the schema PlanOptions, from the table of options. `x-unit`: the unit's symbol;
/// `x-enumDescriptions`: what each word means.
Json options_schema() {
  Json properties;
  for (const OptionRow& row : option_table()) properties[std::string(row.name)] = schema_of(row);
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

/// The component of a status, and its header field in addition to the common fields of every answer.
struct Response {
  int status;
  std::string_view component;
  std::string_view field = {};
  std::string_view field_component = {};
};

constexpr std::array<Response, 15> kResponses{{
    {400, "BadRequest"},
    {401, "Unauthorized", "WWW-Authenticate", "WwwAuthenticate"},
    {403, "Forbidden"},
    {404, "NotFound"},
    {405, "MethodNotAllowed", "Allow", "Allow"},
    {406, "NotAcceptable"},
    {408, "RequestTimeout"},
    {413, "BodyTooLarge"},
    {414, "TargetTooLong"},
    {415, "UnsupportedMediaType", "Accept-Encoding", "AcceptEncoding"},
    {421, "MisdirectedRequest"},
    {422, "InvalidRequest"},
    {431, "HeadTooLarge"},
    {500, "InternalError"},
    {503, "Unavailable", "Retry-After", "RetryAfter"},
}};

/// An example of an error response. The tests compare it with real answers.
struct ProblemExample {
  ErrorCode code;
  std::string_view detail;
  std::string_view name = {};  // empty: the name of the code
};

constexpr std::array<ProblemExample, 22> kExamples{{
    {ErrorCode::malformed_json,
     "Not JSON at line 3, column 14 (byte 47): NaN and infinities are not JSON; give a finite number."},
    {ErrorCode::too_deep, "The JSON nests arrays and objects deeper than the limit of 32 levels."},
    {ErrorCode::malformed_request, "Content-Length and Transfer-Encoding must not be combined."},
    {ErrorCode::unauthorized,
     "Send the service's token as 'Authorization: Bearer ...', or as the password of Basic."},
    {ErrorCode::foreign_origin,
     "Pages of the origin 'https://other.example' may not use this service, unless it is started with "
     "--cors-origin."},
    {ErrorCode::not_found, "There is no example 'corridor'; there are: "},  // the names follow
    {ErrorCode::method_not_allowed, "'/v1/plan' allows POST, not 'GET'."},
    {ErrorCode::not_acceptable,
     "Answers are application/json or text/event-stream, which Accept: 'text/html' excludes: add "
     "application/json or leave the header out."},
    {ErrorCode::request_timeout, "The request's head did not arrive within 10000 ms."},
    {ErrorCode::body_too_large,
     "The body has 40000000 bytes; the limit is 33554432. A large map is smallest as a PNG, in "
     "map.image.png; see "
     "GET /v1/limits."},
    {ErrorCode::target_too_long, "The request target is longer than 8192 bytes."},
    {ErrorCode::unsupported_media_type,
     "The body is declared a web form, as 'curl -d' does: use 'curl --json', or add -H 'Content-Type: "
     "application/json'."},
    {ErrorCode::wrong_host,
     "This service listens on loopback for requests to a local name, not to 'rebound.example': use "
     "localhost, "
     "or start it with --allowed-hosts."},
    {ErrorCode::invalid_request, "The request has 2 faults; see errors."},
    {ErrorCode::check_unfinished,
     "The plans could not be checked within 5000 ms: increase options.time_budget_ms, up to max_budget_ms of "
     "/v1/limits, or send fewer robots or a shorter part of the plans."},
    {ErrorCode::memory_exceeded,
     "The request needs more than 256 MiB of memory, max_plan_memory of /v1/limits: send fewer robots or a "
     "map with fewer cells."},
    {ErrorCode::parse_unfinished,
     "Reading the request was given up after its time budget, or three seconds of CPU time: send a smaller "
     "map, or fewer robots, actions or other values, or increase options.time_budget_ms."},
    {ErrorCode::head_too_large, "There are more than 100 header fields."},
    {ErrorCode::internal_error, "A bug in the service; its log has more under this request_id."},
    {ErrorCode::overloaded, "All workers are busy and the queue is full: try again later."},
    {ErrorCode::overloaded, "Too many large requests are being received: try again later.",
     "overloaded_by_bodies"},
    {ErrorCode::draining, kDrainingDetail},
}};

std::string detail_of(const ProblemExample& example) {
  std::string detail(example.detail);
  if (example.code != ErrorCode::not_found) return detail;
  for (const Example& request : examples()) {
    if (&request != &examples().front()) detail += ", ";
    detail += request.name;
  }
  return detail + '.';
}

std::vector<Fault> faults_of(ErrorCode code) {
  if (code != ErrorCode::invalid_request) return {};
  return {
      {"/robots/0/linear_speed", fault::kOutOfRange,
       "linear_speed must be from 0.001 to 1000 metres per second, not 0."},
      {"/robots/1/start", fault::kStartInObstacle,
       "The start of robot \"amr-2\" does not fit: its disk overlaps a blocked cell or the edge of the map "
       "by 0.2 m (radius 0.2 m). Move it, or correct the map or the radius."}};
}

Json reference(std::string_view section, std::string_view component) {
  std::string address = "#/components/";
  address.append(section).append("/").append(component);
  return {{"$ref", address}};
}

Json examples_of(int status) {
  Json examples;
  for (const ProblemExample& example : kExamples) {
    if (status_of(example.code) != status) continue;
    const std::string_view name = example.name.empty() ? name_of(example.code) : example.name;
    const std::vector<Fault> faults = faults_of(example.code);
    const Reply reply =
        problem_reply({example.code, detail_of(example), faults, faults.size()}, "shift-7.plan-42");
    examples[std::string(name)]["value"] = Json::parse(reply.body);
  }
  return examples;
}

/// Returns when a status is returned: by code, where it has several.
std::string description_of(const std::vector<ErrorRow>& rows) {
  if (rows.size() == 1) return std::string(rows.front().description);
  std::string text;
  for (const ErrorRow& row : rows) {
    text += text.empty() ? "`" : " `";
    text.append(row.name).append("`: ").append(row.description);
  }
  return text;
}

Json response_of(const Response& response) {
  std::vector<ErrorRow> rows;
  Json codes = Json::array();
  for (const ErrorRow& row : error_table()) {
    if (row.status != response.status) continue;
    rows.push_back(row);
    codes.push_back(row.name);
  }
  Json headers{{"X-Request-Id", reference("headers", "RequestId")},
               {"traceparent", reference("headers", "TraceParent")}};
  if (!response.field.empty()) {
    headers[std::string(response.field)] = reference("headers", response.field_component);
  }
  const Json constraint{
      {"properties", {{"status", {{"const", response.status}}}, {"code", {{"enum", codes}}}}}};
  Json content;
  content["schema"]["allOf"] = Json::array({reference("schemas", "Problem"), constraint});
  content["examples"] = examples_of(response.status);
  return {
      {"description", description_of(rows)}, {"headers", headers}, {"content", {{kProblemJson, content}}}};
}

/// Returns the document's `components.responses`, from the table of errors: one for each status.
Json error_responses() {
  Json responses;
  for (const Response& response : kResponses)
    responses[std::string(response.component)] = response_of(response);
  return responses;
}

constexpr std::size_t kLineLength = 110;

std::string key_text(const std::string& key) { return Json(key).dump() + ": "; }

/// Returns the text of a number as Prettier writes it: exponents have no plus sign.
std::string number_text(const Json& number) {
  std::string text = number.dump();
  std::erase(text, '+');
  return text;
}

std::string on_one_line(const Json& value) {
  if (value.is_number()) return number_text(value);
  if (!value.is_structured() || value.empty()) return value.dump();
  std::string text;
  for (const auto& [key, member] : value.items()) {
    text += (text.empty() ? "" : ", ") + (value.is_object() ? key_text(key) : "") + on_one_line(member);
  }
  return value.is_object() ? "{ " + text + " }" : "[" + text + "]";
}

/// Whether Prettier gives every item a line of its own: it does where several items have several members
/// each.
bool needs_lines(const Json& value) {
  if (!value.is_structured()) return false;
  const auto has_several = [](const Json& item) { return item.is_structured() && item.size() > 1; };
  const bool list = value.is_array() && value.size() > 1;
  return (list && std::all_of(value.begin(), value.end(), has_several)) ||
         std::any_of(value.begin(), value.end(), needs_lines);
}

/// Returns the text of a value in the layout of Prettier: two spaces of indent, lines of at most 110
/// characters, and values on one line if they fit. `indent`: the indent of the line on which it begins.
/// `used`: characters on this line before it.
std::string document_text(const Json& value, std::size_t indent, std::size_t used) {
  std::string line = on_one_line(value);
  const bool fits = used + line.size() <= kLineLength && !needs_lines(value);
  if (!value.is_structured() || value.empty() || fits) return line;
  const std::size_t inner = indent + 2;
  std::string text;
  for (const auto& [key, member] : value.items()) {
    const std::string name = value.is_object() ? key_text(key) : "";
    const std::size_t before_and_comma = inner + name.size() + 1;
    text += (text.empty() ? "\n" : ",\n") + std::string(inner, ' ') + name +
            document_text(member, inner, before_and_comma);
  }
  text += '\n' + std::string(indent, ' ');
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

/// Replaces the member that stands on lines of its own at this indent: up to the brace at the same indent.
std::string with_member(const std::string& document, const std::string& key, std::size_t indent,
                        const nlohmann::ordered_json& value) {
  const std::string margin = '\n' + std::string(indent, ' ');
  const std::string name = margin + '"' + key + "\": ";
  const std::size_t begin = document.find(name + "{\n");
  const std::size_t end = begin == std::string::npos ? begin : document.find(margin + '}', begin);
  if (end == std::string::npos) throw std::runtime_error("The document has no " + key + " at its place.");
  const std::string text = document_text(value, indent, name.size());
  return document.substr(0, begin) + name + text + document.substr(end + margin.size() + 1);
}

}  // namespace

std::string with_generated_parts(const std::string& document) {
  const std::string with_responses = with_member(document, "responses", 4, error_responses());
  return with_member(with_responses, "PlanOptions", 6, options_schema());
}

}  // namespace fleetplan::api
