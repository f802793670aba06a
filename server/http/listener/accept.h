#pragma once

namespace fleetplan::server {

/// What a failed accept() means for the listener.
enum class AcceptFault {
  none_waiting,     // there is no connection to accept
  connection_lost,  // that connection is gone; the next one may be fine
  exhausted,        // no descriptors or no memory for now
  broken,           // the listening socket is not one, or no longer
};

/// By the error number that accept() has set (accept(2)).
AcceptFault accept_fault(int error);

/// Accepts a connection on a listening socket that does not block: its descriptor, which is closed on exec
/// and sends small answers at once; or -1 with errno set.
int accept_connection(int listening_fd);

}  // namespace fleetplan::server
