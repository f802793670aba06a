#include "server/http/answer_fields.h"

namespace fleetplan::server {

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

}  // namespace fleetplan::server
