#pragma once

// The routes of a port, as routes.cpp declares them. They give the handler of a request and the label of the
// metrics. They also give the decision before a body is read (404, 405 and its Allow field).

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/response/reply.h"

namespace fleetplan::server {

struct Exchange;

/// Answers a request that has passed all steps. It may add header fields to the exchange.
using Handler = std::function<api::Reply(Exchange&)>;

/// What distinguishes a route besides its method, path and handler.
struct RouteTraits {
  bool without_token = false;      // served to clients that do not send the token
  bool plans = false;              // returns plans
  bool events = false;             // answers as JSON or as a stream of events
  std::vector<int> statuses = {};  // statuses of its answers, in addition to the common statuses of all
                                   // routes
};

struct Route {
  std::string method;  // "GET", which includes HEAD, or "POST", which takes a body
  std::string path;    // as in the OpenAPI document, e.g. "/v1/examples/{name}"
  Handler handler;
  RouteTraits traits;
  std::function<bool(std::string_view path)> contains = {};  // for a folder: whether it has such a file

  bool takes_body() const { return method == "POST"; }
  bool allows(std::string_view sent_method) const;

  /// The methods as an Allow field lists them.
  std::string_view allowed_methods() const { return takes_body() ? "POST" : "GET, HEAD"; }
};

class RouteTable {
 public:
  /// The most bytes of a path that matches a part in braces, or names a file. No name is so long. Finding a
  /// file requires a look-up of every folder on the way.
  static constexpr std::size_t kMaxVariablePath = 1024;

  void get(std::string path, Handler handler, RouteTraits traits = {});
  void post(std::string path, Handler handler, RouteTraits traits = {});

  /// Declares GET of all files of a folder. Declare it last, because other routes have precedence.
  void files(std::string path, std::function<bool(std::string_view path)> contains, Handler handler,
             RouteTraits traits = {});

  struct Match {
    const Route* route = nullptr;  // none: the path is unknown
    std::string parameter = {};    // text that matched the part in braces; for a file, its path
  };

  /// Returns the route of a decoded path. Its method may differ from the method of the request.
  Match find(std::string_view path) const;

  /// The routes in the order of their declaration.
  const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;  // one for each path
};

}  // namespace fleetplan::server
