// Parses a packet with a visitor that does nothing.
#include "net/osc/packets/validate.h"

#include "net/osc/packets/packet_parser.h"

namespace limber::osc {

namespace {

struct NullVisitor {
  static void bundle(int, std::uint64_t) {}
  static void message(const char*, const char*) {}
  static void argument(char, const char*) {}
  static void end_message() {}
};

}  // namespace

const char* packet_fault(const char* data, std::size_t size) {
  NullVisitor visitor;
  return PacketParser<NullVisitor>(visitor).packet(data, size);
}

}  // namespace limber::osc
