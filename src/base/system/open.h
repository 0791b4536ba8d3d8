// Descriptors that child processes do not inherit, opened as each system offers it. For base/system alone.
#pragma once

#include "base/system/descriptor.h"

namespace limber::system {

/// Both ends of a pipe, blocking. False: errno says why not.
bool open_pipe(Descriptor& read_end, Descriptor& write_end);
/// A socket that never blocks; closed: errno says why.
Descriptor open_socket(int family, int type);
void set_nonblocking(int fd);
void set_blocking(int fd);

}  // namespace limber::system
