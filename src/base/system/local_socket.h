// Stream sockets between programs of one machine, which have a path. [any]
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::system {

/// A non-blocking socket that listens at `path` and that only this user may open (0600). The path appears only once it
/// listens, so that no program takes it for a dead one. The error says why not.
Result<Descriptor> listen_local(const std::string& path);

/// A non-blocking connection. Where many wait to be accepted it waits too, for at most `seconds`. The error says why
/// there is none.
Result<Descriptor> connect_local(const std::string& path, int seconds);

/// Whether a program listens at a path.
enum class Listener : std::uint8_t { present, gone, unknown };
Listener find_listener(const std::string& path);

/// The next connection of a listening socket, not blocking; closed: errno says why.
Descriptor accept_connection(int listener);
/// The user at the other end of a connection; -1: the system does not know.
long peer_user(const Descriptor& connection);

}  // namespace limber::system
