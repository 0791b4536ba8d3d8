// Decoding: the value of each type tag, flattened bundles and arrays, rejected types, and round trips.
#include "net/osc/packets/decode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "net/osc/packets/encode.h"
#include "net/osc/packets/validate.h"
#include "osc/osc_test_tools.h"

namespace limber::osc {
namespace {

using namespace test;

Decoded decoded(const std::string& bytes) {
  EXPECT_EQ(packet_fault(bytes.data(), bytes.size()), nullptr);
  Result<Decoded> result = decode_packet(bytes.data(), bytes.size());
  EXPECT_TRUE(result.ok());
  return result.ok() ? *result : Decoded{};
}

Arg only_argument(const std::string& bytes) {
  const Decoded d = decoded(bytes);
  EXPECT_EQ(d.messages.size(), 1u);
  EXPECT_EQ(d.messages.at(0).args.size(), 1u);
  return d.messages.at(0).args.at(0);
}

TEST(Decode, NumericTagsBecomeNumbers) {
  EXPECT_EQ(only_argument(Bytes().text("/a").text(",i").u32(0xfffffff9u).str()).number, -7);
  EXPECT_EQ(only_argument(Bytes().text("/a").text(",f").f(-7.5f).str()).number, -7.5);
  EXPECT_EQ(only_argument(Bytes().text("/a").text(",d").d(0.1).str()).number, 0.1);
  EXPECT_EQ(only_argument(Bytes().text("/a").text(",h").u64(std::uint64_t{1} << 40).str()).number, 1099511627776.0);
  for (const char* tag : {",i", ",f", ",d", ",h"}) {
    EXPECT_EQ(only_argument(Bytes().text("/a").text(tag).u64(0).str()).kind, Arg::Kind::number) << tag;
  }
}

TEST(Decode, KeepsNanAndInfinity) {
  EXPECT_TRUE(std::isnan(only_argument(Bytes().text("/a").text(",f").u32(0x7fc00000u).str()).number));
  EXPECT_EQ(only_argument(Bytes().text("/a").text(",f").u32(0xff800000u).str()).number,
            -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(only_argument(Bytes().text("/a").text(",d").u64(0x7ff8000000000000u).str()).number));
}

TEST(Decode, DecodesNonNumericTags) {
  const Decoded d = decoded(Bytes().text("/a").text(",TFINsSc").text("arm").text("tip").u32('q').str());
  const std::vector<Arg>& a = d.messages.at(0).args;
  ASSERT_EQ(a.size(), 7u);
  for (const std::size_t i : {0u, 1u, 2u}) EXPECT_EQ(a[i].kind, Arg::Kind::boolean) << i;
  EXPECT_EQ(a[0].number, 1);
  EXPECT_EQ(a[1].number, 0);
  EXPECT_EQ(a[2].number, 1);
  EXPECT_EQ(a[3].kind, Arg::Kind::nil);
  EXPECT_EQ(a[4].text, "arm");
  EXPECT_EQ(a[5].text, "tip");
  EXPECT_EQ(a[6].text, "q");
}

TEST(Decode, AcceptsMissingTypeTags) {
  for (const std::string& bytes :
       {Bytes().text("/transport/pause").str(), Bytes().text("/transport/pause").text(",").str()}) {
    const Decoded d = decoded(bytes);
    ASSERT_EQ(d.messages.size(), 1u);
    EXPECT_EQ(d.messages[0].address, "/transport/pause");
    EXPECT_TRUE(d.messages[0].args.empty());
    EXPECT_EQ(d.time_tag, 1u);
  }
}

TEST(Decode, FlattensArrays) {
  const Decoded d = decoded(Bytes().text("/a").text(",s[fff]i").text("arm").f(1).f(2).f(3).u32(4).str());
  const std::vector<Arg>& a = d.messages.at(0).args;
  ASSERT_EQ(a.size(), 5u);
  EXPECT_EQ(a[0].text, "arm");
  for (std::size_t i = 1; i < 5; i++) EXPECT_EQ(a[i].number, static_cast<double>(i));
}

TEST(Decode, ReportsUnsupportedTags) {
  const std::pair<std::string, std::string> cases[] = {
      {Bytes().text("/a").text(",b").u32(4).raw("abcd").str(), "a blob (b)"},
      {Bytes().text("/a").text(",t").u64(1).str(), "a time tag (t)"},
      {Bytes().text("/a").text(",m").u32(1).str(), "a MIDI message (m)"},
      {Bytes().text("/a").text(",r").u32(1).str(), "a packed color (r)"},
      {Bytes().text("/a").text(",[[f]]").f(1).str(), "nested arrays"},
  };
  for (const auto& [bytes, reason] : cases) {
    const Decoded d = decoded(bytes);
    EXPECT_TRUE(d.messages.empty());
    ASSERT_EQ(d.rejected.size(), 1u) << reason;
    EXPECT_EQ(d.rejected[0].address, "/a");
    EXPECT_EQ(d.rejected[0].reason.rfind(reason, 0), 0u) << d.rejected[0].reason;
  }
}

TEST(Decode, FlattensBundlesInOrder) {
  const std::string blob = Bytes().text("/b").text(",b").u32(0).str();
  const Decoded d =
      decoded(bundle(77, {numbered(1), bundle(99, {numbered(2), bundle(1, {}), numbered(3)}), blob, numbered(4)}));
  EXPECT_EQ(d.time_tag, 77u);
  ASSERT_EQ(d.messages.size(), 4u);
  for (std::size_t i = 0; i < 4; i++) EXPECT_EQ(d.messages[i].args.at(0).number, static_cast<double>(i + 1));
  ASSERT_EQ(d.rejected.size(), 1u);
  EXPECT_EQ(d.rejected[0].address, "/b");
}

TEST(Encode, WritesExactBytes) {
  PacketBuffer buffer;
  Message m{"/pulse", {Arg::of(1.5), Arg::of(true), Arg::of("arm"), Arg::of(false), Arg{}}};
  const auto packet = encode_message(m, buffer);
  EXPECT_EQ(std::string(packet.begin(), packet.end()),
            Bytes().text("/pulse").text(",fisii").f(1.5f).u32(1).text("arm").u32(0).u32(0).str());
  const auto pong = encode_pong(0x180000005u, 2.25, buffer);
  EXPECT_EQ(std::string(pong.begin(), pong.end()), Bytes().text("/pong").text(",if").u32(5).f(2.25f).str());
}

TEST(Encode, ClampsToFloatRange) {
  PacketBuffer buffer;
  const auto packet = encode_message({"/a", {Arg::of(1e300), Arg::of(-1e300)}}, buffer);
  EXPECT_EQ(std::string(packet.begin(), packet.end()), Bytes()
                                                           .text("/a")
                                                           .text(",ff")
                                                           .f(std::numeric_limits<float>::max())
                                                           .f(std::numeric_limits<float>::lowest())
                                                           .str());
}

TEST(Encode, LimitsDatagramSize) {
  PacketBuffer buffer;
  Message m{"/a", {}};
  // n floats take 4 + padded(1 + n + 1) + 4 n bytes; n = 13099 gives 4 + 13104 + 52396 = 65504
  m.args.assign(13099, Arg::of(1.0));
  EXPECT_EQ(encode_message(m, buffer).size(), 65504u);
  m.args.push_back(Arg::of(1.0));
  EXPECT_TRUE(encode_message(m, buffer).empty());
}

// Encoded messages are decoded again: numbers as the nearest float, booleans as 0 and 1, texts unchanged.
TEST(Encode, RoundTrips) {
  Random random(11);
  PacketBuffer buffer;
  for (int i = 0; i < 5000; i++) {
    Message m{"/", {}};
    for (std::uint64_t k = random.next() % 30; k > 0; k--) m.address += static_cast<char>('a' + random.next() % 26);
    for (std::uint64_t k = random.next() % 12; k > 0; k--) {
      switch (random.next() % 3) {
        case 0:
          m.args.push_back(Arg::of(random.uniform(-1e6, 1e6)));
          break;
        case 1:
          m.args.push_back(Arg::of(random.next() % 2 == 0));
          break;
        default:
          m.args.push_back(Arg::of(std::string_view(std::string(random.next() % 40, static_cast<char>('A' + i % 26)))));
      }
    }
    const auto packet = encode_message(m, buffer);
    const Decoded d = decoded(std::string(packet.begin(), packet.end()));
    ASSERT_EQ(d.messages.size(), 1u);
    EXPECT_EQ(d.messages[0].address, m.address);
    ASSERT_EQ(d.messages[0].args.size(), m.args.size());
    for (std::size_t k = 0; k < m.args.size(); k++) {
      EXPECT_EQ(d.messages[0].args[k].text, m.args[k].text);
      EXPECT_EQ(d.messages[0].args[k].number, static_cast<double>(static_cast<float>(m.args[k].number)));
    }
  }
}

}  // namespace
}  // namespace limber::osc
