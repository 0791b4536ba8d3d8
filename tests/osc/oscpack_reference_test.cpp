// Compares Limber's OSC codec with oscpack, an independent implementation: both accept the same packets, decode the
// same values and write the same bytes.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "net/osc/packets/encode.h"
#include "net/osc/packets/packet_writer.h"
#include "net/osc/packets/validate.h"
#include "osc/bad_packets.h"
#include "osc/oscpack_reference.h"
#include "osc/same_decoded.h"
#include "support/skip.h"

namespace limber::osc {
namespace {

using namespace test;

// Writes the same random packet with both writers.
class RandomPacket {
 public:
  explicit RandomPacket(std::uint64_t seed) : random_(seed, "packet") {}

  template <class Writer>
  void write(Writer& out) {
    if (below(3) == 0) {
      bundle(out, 1);
    } else {
      message(out);
    }
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_.next() % n; }

  template <class Writer>
  void bundle(Writer& out, int depth) {
    out.begin_bundle(random_.next());
    for (std::uint64_t k = below(4); k > 0; k--) {
      if (depth < 8 && below(3) == 0) {
        bundle(out, depth + 1);
      } else {
        message(out);
      }
    }
    out.end_bundle();
  }

  std::string word(std::uint64_t longest) {
    std::string word(below(longest), ' ');
    for (char& c : word) c = static_cast<char>('!' + below('~' - '!'));
    return word;
  }

  template <class Writer>
  void message(Writer& out) {
    std::string tags;
    int level = 0;
    for (std::uint64_t k = below(20); k > 0; k--) {
      const char tag = "ihfdTFNIsScrmtb[]"[below(17)];
      if (tag == ']' && level == 0) continue;
      level += tag == '[' ? 1 : tag == ']' ? -1 : 0;
      tags += tag;
    }
    tags += std::string(static_cast<std::size_t>(level), ']');
    const std::string address = "/" + word(40);
    out.begin_message(address.c_str(), tags.size());
    for (const char tag : tags) argument(out, tag);
    out.end_message();
  }

  template <class Writer>
  void argument(Writer& out, char tag) {
    const std::uint64_t bits = random_.next();
    switch (tag) {
      case 'i':
        return out.int32(static_cast<std::int32_t>(bits));
      case 'h':
        return out.int64(static_cast<std::int64_t>(bits));
      case 'f':
        return out.float32(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      case 'd':
        return out.float64(std::bit_cast<double>(bits));
      case 'T':
      case 'F':
        return out.boolean(tag == 'T');
      case 'N':
        return out.nil();
      case 'I':
        return out.infinitum();
      case 's':
        return out.string(word(30).c_str());
      case 'S':
        return out.symbol(word(30).c_str());
      // oscpack sign-extends characters beyond ASCII, which OSC does not define
      case 'c':
        return out.character(static_cast<char>(bits % 128));
      case 'r':
        return out.color(static_cast<std::uint32_t>(bits));
      case 'm':
        return out.midi(static_cast<std::uint32_t>(bits));
      case 't':
        return out.time_tag(bits);
      case 'b':
        return out.blob(word(30));
      case '[':
        return out.begin_array();
      default:
        return out.end_array();
    }
  }

  Random random_;
};

std::string random_packet(std::uint64_t seed) {
  PacketBuffer buffer;
  PacketWriter out(buffer.bytes.data(), buffer.bytes.size());
  RandomPacket(seed).write(out);
  return text_of(out.packet());
}

TEST(OscpackReference, WritesTheSameBytes) {
  PacketBuffer buffer;
  std::size_t bytes = 0;
  for (std::uint64_t seed = 1; seed <= 5000; seed++) {
    oscpack_reference::Writer theirs(buffer.bytes.data(), buffer.bytes.size());
    RandomPacket(seed).write(theirs);
    const std::string packet = random_packet(seed);
    ASSERT_EQ(packet, text_of(theirs.packet())) << "seed " << seed;
    bytes += packet.size();
  }
  EXPECT_GT(bytes, 500000u);
}

TEST(OscpackReference, ReadsTheSameValues) {
  std::size_t messages = 0;
  std::size_t rejected = 0;
  for (std::uint64_t seed = 1; seed <= 5000; seed++) {
    const std::string packet = random_packet(seed);
    ASSERT_EQ(packet_fault(packet.data(), packet.size()), nullptr) << "seed " << seed;
    const Result<Decoded> ours = exact_decoded(packet);
    const Result<Decoded> theirs = oscpack_reference::decode_packet(packet.data(), packet.size());
    ASSERT_TRUE(ours.ok() && theirs.ok()) << "seed " << seed;
    ASSERT_TRUE(same(*ours, *theirs)) << "seed " << seed;
    messages += ours->messages.size();
    rejected += ours->rejected.size();
  }
  EXPECT_GT(messages, 1000u);
  EXPECT_GT(rejected, 1000u);
}

// True for packets that Limber rejects and on which oscpack would read or loop out of bounds.
bool is_unsafe_for_oscpack(std::string_view fault) {
  return fault.starts_with("a blob") || fault == "a bundle's element is larger than the bundle";
}
// True for rules that only Limber has: limits, addresses, NULs after the end of a string, "][".
bool is_stricter_than_oscpack(std::string_view fault) {
  for (const char* rule :
       {"larger than 65504", "it begins with neither", "bundles nested deeper", "more than", "an address",
        "a string that does not end", "type tags that do not end", "a string longer", "unbalanced arrays"}) {
    if (fault.starts_with(rule)) return true;
  }
  return false;
}

TEST(OscpackReference, AcceptsTheSameMutatedPackets) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  Random random(7);
  int accepted = 0;
  int rejected = 0;
  for (int i = 0; i < 100000; i++) {
    std::string packet = random_packet(static_cast<std::uint64_t>(i % 500));
    for (std::uint64_t k = 1 + random.next() % 3; k > 0; k--) {
      const std::uint64_t r = random.next();
      packet[r % packet.size()] = (r >> 40) % 2 == 0 ? static_cast<char>(r >> 32) : "\0,[]bsTi/#"[(r >> 48) % 10];
    }
    if (random.next() % 8 == 0) packet.resize(random.next() % packet.size());
    const Result<Decoded> ours = exact_decoded(packet);
    if (!ours.ok() && (is_unsafe_for_oscpack(ours.error()) || is_stricter_than_oscpack(ours.error()))) continue;
    const Result<Decoded> theirs = oscpack_reference::decode_packet(packet.data(), packet.size());
    ASSERT_EQ(ours.ok(), theirs.ok()) << i << ' ' << testing::PrintToString(packet) << ' '
                                      << (ours.ok() ? theirs.error() : ours.error());
    if (ours.ok()) {
      ASSERT_TRUE(same(*ours, *theirs)) << i << ' ' << testing::PrintToString(packet);
    }
    (ours.ok() ? accepted : rejected)++;
  }
  EXPECT_GT(accepted, 10000);
  EXPECT_GT(rejected, 10000);
}

// The documented differences: malformed packets that oscpack accepts.
TEST(OscpackReference, AcceptsMalformedPacketsThatLimberRejects) {
  const std::pair<const char*, std::string> cases[] = {
      {"unbalanced arrays", from_hex("2f610000 2c5d5b69 00000000 00000007")},
      {"type tags that do not end", from_hex("2f610000 2c000069")},
      {"a string that does not end", from_hex("2f610000 2c730000 00616263")},
      {"it begins with neither '/' nor '#bundle'", from_hex("61620000 2c000000")},
      {"an address that is not printable ASCII", from_hex("2f610700 2c000000")},
      {"bundles nested deeper than 8", nested(9)},
  };
  for (const auto& [fault, packet] : cases) {
    EXPECT_TRUE(oscpack_reference::decode_packet(packet.data(), packet.size()).ok()) << fault;
    const Result<Decoded> ours = exact_decoded(packet);
    ASSERT_FALSE(ours.ok()) << fault;
    EXPECT_EQ(ours.error(), fault);
  }
}

TEST(OscpackReference, EncodesTheSameMessages) {
  Random random(3);
  PacketBuffer ours;
  oscpack_reference::Encoder theirs;
  const double numbers[] = {0,
                            -0.0,
                            -7,
                            2147483647.4,
                            2147483648.0,
                            -2147483649.0,
                            9.3e18,
                            -9.3e18,
                            1e300,
                            0.1,
                            std::numeric_limits<double>::infinity(),
                            std::nan("")};
  for (int i = 0; i < 20000; i++) {
    Message m{"/x" + std::string(random.next() % 9, 'y'), {}};
    std::string tags;
    for (std::uint64_t k = random.next() % 12; k > 0; k--) {
      const char tag = "ihfdTFNIsScrmtb"[random.next() % 15];
      tags += random.next() % 5 == 0 ? std::string("[") + tag + "]" : std::string(1, tag);
      const bool text = std::string_view("sScrmtb").find(tag) != std::string_view::npos;
      if (text) {
        m.args.push_back(Arg::of(std::string_view("0123456789abcdef0123").substr(0, random.next() % 21)));
      } else {
        m.args.push_back(tag == 'T' ? Arg::of(random.next() % 2 == 0) : Arg::of(numbers[random.next() % 12]));
      }
    }
    ASSERT_EQ(text_of(encode_tagged(m, tags, ours)), text_of(theirs.tagged(m, tags))) << tags;
    ASSERT_EQ(text_of(encode_message(m, ours)), text_of(theirs.message(m)));
    ASSERT_EQ(text_of(encode_pong(random.next(), numbers[i % 12], ours)).size(), 20u);
  }
  const std::pair<std::uint64_t, double> ticks[] = {{0, 0}, {0x7fffffff, 2147483647}, {0x180000005, 5}};
  for (const auto& [tick, sent] : ticks) {
    EXPECT_EQ(text_of(encode_pong(tick, -0.1, ours)),
              text_of(theirs.tagged({"/pong", {Arg::of(sent), Arg::of(-0.1)}}, "if")));
  }
}

}  // namespace
}  // namespace limber::osc
