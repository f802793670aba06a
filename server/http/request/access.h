#pragma once

// Who may use the service: clients with the token, under allowed host names, from pages of allowed origins;
// and which client a request is from, also behind proxies that an operator trusts.

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
  /// Makes a token from a text of visible ASCII. Returns the fault of another text, without the text.
  static std::variant<AccessToken, std::string> from_text(std::string_view text);

  /// Makes a token from the only line of a file; line ends behind it are dropped.
  static std::variant<AccessToken, std::string> from_file(const std::string& path);

  /// Whether an Authorization field (empty: absent) contains the token: as `Bearer TOKEN`, or as the password
  /// of `Basic` with any user name, for which browsers show a dialog. The time does not depend on how much of
  /// the token is right.
  bool admits(std::string_view authorization) const;

 private:
  explicit AccessToken(std::string_view token) : token_(token) {}
  bool equals(std::string_view shown) const;

  std::string token_;
};

/// Decodes base64 of RFC 4648, with or without padding; none when the text is not base64.
std::optional<std::string> base64_decoded(std::string_view text);

/// The names by which requests may address a service that listens on loopback. A page on the web can have the
/// name of its own server resolved to 127.0.0.1 ("DNS rebinding"); the browser then treats this service as
/// the page's own server, but the Host field still has the page's name.
class AllowedHosts {
 public:
  /// Restricts requests only if `listening`, the address of the service, is a local name. `names` are allowed
  /// besides local names, without port; `*` for any.
  AllowedHosts(std::string_view listening, const std::vector<std::string>& names);

  /// Whether the request may address the service; true for a request without Host (HTTP/1.0), which no
  /// browser sends.
  bool admits(const RequestHead& head) const;

 private:
  bool any_;
  std::vector<std::string> names_;  // in lower case
};

/// Returns why AllowedHosts does not accept this name; none when it does.
std::optional<std::string> host_name_fault(std::string_view name);

/// The pages of other origins that may use the service and read answers in a browser (the Fetch standard's
/// CORS protocol). Without credentials of the browser: a page sends the token itself.
class CrossOrigin {
 public:
  /// Allows pages of these `origins`: each `scheme://host[:port]`, or `*` for any. Empty: no page of another
  /// origin.
  explicit CrossOrigin(std::vector<std::string> origins);

  /// Returns the header fields of every answer to this request.
  HeaderFields answer_fields(const RequestHead& head) const;

  /// Whether the request does not come from a page of another origin, or that page is allowed. A page whose
  /// origin has the host and port of the request is the service's own: with a proxy that terminates TLS, the
  /// schemes differ.
  bool admits(const RequestHead& head) const;

  /// Whether this is the preflight that a browser sends before the request of a page that is allowed.
  bool is_preflight(const RequestHead& head) const;

  /// Returns the header fields of the answer to a preflight. `methods`: those of the resource.
  static HeaderFields preflight_fields(std::string_view methods);

 private:
  bool allows(std::string_view origin) const;

  std::vector<std::string> origins_;
  bool any_;
};

/// Returns why CrossOrigin does not accept this origin; none when it does.
std::optional<std::string> origin_fault(std::string_view origin);

/// An IP address; one of IPv4 as IPv6 maps it.
using IpAddress = std::array<std::uint8_t, 16>;

/// Reads an address without a port. Returns none when the text is not an address.
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

/// Returns the client that sent a request, as far as shares of the server are concerned: its address, or for
/// IPv6 the network of 64 bits, which one client may use alone. Behind trusted proxies, it is the last
/// address that they forwarded and that is not a trusted proxy itself.
///
/// `peer`: see Socket::peer. `forwarded`: the values of X-Forwarded-For.
std::string client_of(const std::string& peer, const std::string& forwarded,
                      const std::vector<AddressRange>& trusted_proxies);

}  // namespace fleetplan::server
