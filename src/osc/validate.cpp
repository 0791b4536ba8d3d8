// The walk through a packet without building anything.
#include "osc/validate.h"

#include "osc/packet_walk.h"

namespace limber {

namespace {

struct Nothing {
  static void bundle(int, std::uint64_t) {}
  static void message(const char*, const char*) {}
  static void argument(char, const char*) {}
  static void end_message() {}
};

}  // namespace

const char* packet_fault(const char* data, std::size_t size) {
  Nothing nothing;
  return PacketWalk<Nothing>(nothing).packet(data, size);
}

}  // namespace limber
