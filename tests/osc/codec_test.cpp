// Decoding and encoding of all types, against hand-written bytes.
#include <gtest/gtest.h>

#include "net/osc/packets/decode.h"
#include "net/osc/packets/encode.h"
#include "osc/bad_packets.h"
#include "osc/same_decoded.h"

namespace limber::osc {
namespace {

using namespace test;

TEST(Codec, DecodesEveryTypeThatAddressesAccept) {
  const std::string bytes = Bytes()
                                .text("/a")
                                .text(",ihfdTFNIsSc[ii]")
                                .u32(0x80000000u)
                                .u64(0x8000000000000000u)
                                .f(-0.0f)
                                .d(-1e300)
                                .text("arm")
                                .text("tip")
                                .u32('q')
                                .u32(0xffffffffu)
                                .u32(7)
                                .str();
  const Result<Decoded> d = exact_decoded(bytes);
  ASSERT_TRUE(d.ok());
  const std::vector<Arg> expected = {Arg::of(-2147483648.0),
                                     Arg::of(-9223372036854775808.0),
                                     Arg::of(-0.0),
                                     Arg::of(-1e300),
                                     Arg::of(true),
                                     Arg::of(false),
                                     Arg{},
                                     Arg::of(true),
                                     Arg::of("arm"),
                                     Arg::of("tip"),
                                     Arg::of("q"),
                                     Arg::of(-1.0),
                                     Arg::of(7.0)};
  EXPECT_TRUE(same(*d, Decoded{{{"/a", expected}}, {}, 1}));
}

TEST(Codec, RejectsEveryBadPacket) {
  for (const BadPacket& bad : bad_packets()) EXPECT_FALSE(exact_decoded(bad.bytes).ok()) << bad.description;
}

TEST(Codec, NeverReadsPastATruncatedPacket) {
  const std::string whole = bundle(
      9,
      {Bytes().text("/ab").text(",s[f]bth").text("name").f(1).u32(5).raw("abcdefgh").u64(3).u64(4).str(), numbered(7)});
  ASSERT_TRUE(exact_decoded(whole).ok());
  int accepted = 0;
  for (std::size_t n = 0; n < whole.size(); n++) accepted += exact_decoded(whole.substr(0, n)).ok() ? 1 : 0;
  EXPECT_EQ(accepted, 2) << "the header alone, and the header with the first message";
}

TEST(Codec, EncodesRareTypesFromHexadecimalDigits) {
  PacketBuffer buffer;
  const Message m{"/a",
                  {Arg::of("ff800001"), Arg::of("00903C7F"), Arg::of("8000000000000001"), Arg::of("00ff7"),
                   Arg::of("sym"), Arg::of("q"), Arg::of(0.1), Arg{}, Arg::of(false)}};
  EXPECT_EQ(text_of(encode_tagged(m, "rmtbScdIF", buffer)), Bytes()
                                                                .text("/a")
                                                                .text(",rmtbScdIF")
                                                                .u32(0xff800001u)
                                                                .u32(0x00903c7fu)
                                                                .u64(0x8000000000000001u)
                                                                .u32(2)
                                                                .raw(std::string("\0\xff\0\0", 4))
                                                                .text("sym")
                                                                .u32('q')
                                                                .d(0.1)
                                                                .str());
}

TEST(Codec, LimitsDatagramSize) {
  PacketBuffer buffer;
  Message m{"/a", std::vector<Arg>(13099, Arg::of(1.0))};
  EXPECT_EQ(encode_message(m, buffer).size(), 65504u);
  m.args.push_back(Arg::of(1.0));
  EXPECT_TRUE(encode_message(m, buffer).empty());
}

}  // namespace
}  // namespace limber::osc
