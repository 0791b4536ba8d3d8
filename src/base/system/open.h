// Opens descriptors that child processes do not inherit. Private to base/system.
#pragma once

#include "base/system/descriptor.h"

namespace limber::system {

/// Opens a blocking pipe. False on error, with errno set.
bool open_pipe(Descriptor& read_end, Descriptor& write_end);
/// Opens a non-blocking socket. Returns a closed descriptor on error, with errno set.
Descriptor open_socket(int family, int type);
void set_nonblocking(int fd);
void set_blocking(int fd);

}  // namespace limber::system
