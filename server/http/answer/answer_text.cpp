#include "server/http/answer/answer_text.h"

#include <string_view>
#include <utility>

namespace fleetplan::server {

namespace {

std::string_view reason_phrase(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 406:
      return "Not Acceptable";
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 415:
      return "Unsupported Media Type";
    case 421:
      return "Misdirected Request";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "Error";
  }
}

}  // namespace

DirectAnswer refusal(const Exchange& exchange, api::ErrorCode code, const std::string& detail,
                     HeaderFields fields) {
  return {api::problem_reply(code, detail, exchange.request_id), std::move(fields)};
}

HeaderFields common_fields(const Exchange& exchange) {
  HeaderFields fields{{"X-Request-Id", exchange.request_id}, {"X-Content-Type-Options", "nosniff"}};
  fields.insert(fields.end(), exchange.fields.begin(), exchange.fields.end());
  if (exchange.status == 503) fields.emplace_back("Retry-After", std::to_string(exchange.retry_after_s));
  if (exchange.close) {
    fields.emplace_back("Connection", "close");
  } else if (exchange.head.http_1_0) {
    fields.emplace_back("Connection", "keep-alive");
  }
  return fields;
}

std::string answer_head(const Exchange& exchange, int status, const HeaderFields& further) {
  std::string text = "HTTP/1.1 " + std::to_string(status) + ' ';
  text += reason_phrase(status);
  text += "\r\n";
  const auto add = [&](const std::string& name, const std::string& value) {
    text += name + ": " + value + "\r\n";
  };
  for (const auto& [name, value] : common_fields(exchange)) add(name, value);
  for (const auto& [name, value] : further) add(name, value);
  return text + "\r\n";
}

std::string answer_text(const Exchange& exchange, const DirectAnswer& answer) {
  const api::Reply& reply = answer.reply;
  HeaderFields fields = answer.fields;
  if (reply.status != 204) {
    fields.emplace_back("Content-Type", reply.content_type);
    fields.emplace_back("Content-Length", std::to_string(reply.body.size()));
  }
  std::string text = answer_head(exchange, reply.status, fields);
  if (exchange.head.method != "HEAD") text += reply.body;
  return text;
}

}  // namespace fleetplan::server
