// SerialSender: sends packets to a serial port without waiting. While the port accepts no bytes, the newest packet is
// kept and replaces older ones; a packet that has begun is always completed. [one thread]
#pragma once

#include <string>

#include "base/result.h"
#include "base/system/descriptor.h"

namespace limber::lighting {

class SerialSender {
 public:
  SerialSender() = default;
  ~SerialSender() { close(); }
  SerialSender(const SerialSender&) = delete;
  SerialSender& operator=(const SerialSender&) = delete;

  Result<void> open(const std::string& device);
  bool is_open() const { return port_.is_open(); }
  int fd() const { return port_.fd(); }
  /// True if flush() has work once the port is writable.
  bool has_unsent() const { return !begun_.empty() || !next_.empty(); }

  /// Sends a packet, now or with flush(). Returns 0, or an errno after which the port is closed: the device is gone.
  int send(const std::string& packet);
  int flush();
  /// Closes the port, after waiting at most 0.1 s each for the last packet to be written and to be received.
  void close();

 private:
  system::Descriptor port_;
  std::string begun_;  // the rest of the packet that is being written
  std::string next_;
};

}  // namespace limber::lighting
