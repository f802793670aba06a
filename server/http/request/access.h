#pragma once

// Who may use the service: clients with the token, under allowed host names, from pages of allowed origins.
// Also: which client a request is from, even behind proxies that an operator trusts.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/http/request/request_head.h"

namespace fleetplan::server {

/// The secret that requests must send. It is never logged.
class AccessToken {
 public:
  /// Makes a token from a text of visible ASCII. Otherwise, returns the fault of the text, without the text.
  static std::variant<AccessToken, std::string> from_text(std::string_view text);

  /// Makes a token from the only line of a file. Ends of lines after it are dropped.
  static std::variant<AccessToken, std::string> from_file(const std::string& path);

  /// Whether an Authorization field (empty: absent) contains the token. It may be `Bearer TOKEN`, or the
  /// password of `Basic` with any user name, for which browsers show a dialog. The time does not depend on
  /// how much of the token is right.
  bool admits(std::string_view authorization) const;

 private:
  explicit AccessToken(std::string_view token) : token_(token) {}
  bool equals(std::string_view shown) const;

  std::string token_;
};

/// Decodes base64 of RFC 4648, with or without padding. None if the text is not base64.
std::optional<std::string> base64_decoded(std::string_view text);

/// The names by which requests may address a service that listens on loopback. A page on the web can make the
/// name of its own server resolve to 127.0.0.1 ("DNS rebinding"). The browser then treats this service as the
/// page's own server. But the Host field still has the page's name.
class AllowedHosts {
 public:
  /// Restricts requests only if `listening`, the address of the service, is a local name. `names` are allowed
  /// in addition to local names, without port; `*` for any.
  AllowedHosts(std::string_view listening, const std::vector<std::string>& names);

  /// Whether the request may address the service. True for a request without Host (HTTP/1.0), because
  /// browsers never send one.
  bool admits(const RequestHead& head) const;

 private:
  bool any_;
  std::vector<std::string> names_;  // in lower case
};

/// Returns why AllowedHosts does not accept this name; none if it does.
std::optional<std::string> host_name_fault(std::string_view name);

/// The pages of other origins that may use the service and read answers in a browser (the Fetch standard's
/// CORS protocol). The browser sends no credentials: a page sends the token itself.
class CrossOrigin {
 public:
  /// Allows pages of these `origins`: each is `scheme://host[:port]`, or `*` for any. Empty: no page of
  /// another origin.
  explicit CrossOrigin(std::vector<std::string> origins);

  /// Returns the header fields of every answer to this request.
  HeaderFields answer_fields(const RequestHead& head) const;

  /// Whether the request may come from its page: the page is of the service's own origin or allowed, or there
  /// is none. A page is the service's own if its origin has the host and port of the request. The schemes may
  /// differ, because a proxy may terminate TLS.
  bool admits(const RequestHead& head) const;

  /// Whether this is the preflight that a browser sends before the request of a page that is allowed.
  bool is_preflight(const RequestHead& head) const;

  /// Returns the header fields of the answer to a preflight. `methods`: the methods of the resource.
  static HeaderFields preflight_fields(std::string_view methods);

 private:
  bool allows(std::string_view origin) const;

  std::vector<std::string> origins_;
  bool any_;
};

/// Returns why CrossOrigin does not accept this origin; none if it does.
std::optional<std::string> origin_fault(std::string_view origin);

/// An IP address. IPv4 addresses are mapped to IPv6.
using IpAddress = std::array<std::uint8_t, 16>;

/// Reads an address without a port. Returns none if the text is not an address.
std::optional<IpAddress> ip_address(const std::string& text);

/// Addresses with the same first bits.
class AddressRange {
 public:
  /// Reads an address, or an address with the number of bits after a slash: 10.0.0.0/8.
  static std::optional<AddressRange> from_text(const std::string& text);

  bool contains(const IpAddress& address) const;

 private:
  AddressRange(const IpAddress& first, unsigned bits) : first_(first), bits_(bits) {}

  IpAddress first_;
  unsigned bits_;
};

/// Returns the client that sent a request, to share the server fairly between clients. The client is its
/// address, or for IPv6 the network of 64 bits, which one client may use alone. Behind trusted proxies, it is
/// the last address that they forwarded and that is not a trusted proxy itself.
///
/// `peer`: see Socket::peer. `forwarded`: the values of X-Forwarded-For.
std::string client_of(const std::string& peer, const std::string& forwarded,
                      const std::vector<AddressRange>& trusted_proxies);

}  // namespace fleetplan::server
