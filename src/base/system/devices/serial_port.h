// Serial ports, for devices such as interfaces for DMX: bytes without control characters or echo, never blocking. [any]
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::system {

/// Opens a serial port with 8 data bits at 115200 baud, which adapters by USB ignore, and locks it until it is closed.
/// The error is the system's message with a fix, as when another program has locked it, or it isn't a serial port.
Result<Descriptor> open_serial_port(const std::string& path);

/// Writes as many bytes as the port accepts now. Returns their number, or -1 with errno set: the device is gone.
std::ptrdiff_t write_serial_port(int fd, std::string_view bytes);

/// Waits until the device has received the written bytes, at most `limit`, drops the rest, and closes the port.
void close_serial_port(Descriptor port, std::chrono::milliseconds limit);

}  // namespace limber::system
