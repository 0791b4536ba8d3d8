// Unix domain stream sockets. [any]
#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::system {

/// Returns a non-blocking socket that listens at `path` and that only this user may open (0600). The path appears when
/// the socket already listens, so that no program considers it stale.
Result<Descriptor> listen_local(const std::string& path);

/// Returns a non-blocking connection. Waits at most `seconds` if the listener's backlog is full.
Result<Descriptor> connect_local(const std::string& path, int seconds);

/// Whether a program listens at a path.
/// gone: the socket is stale. unknown: there is no socket, or it can't be opened.
enum class Listener : std::uint8_t { present, absent, unknown };
Listener find_listener(const std::string& path);

/// Accepts a connection, which is non-blocking. Returns a closed descriptor on error, with errno set.
Descriptor accept_connection(int listener);
/// Returns the user id of the peer, or -1 if unknown.
long peer_user(const Descriptor& connection);

}  // namespace limber::system
