// The validator accepts valid packets, rejects each malformed one for its own reason, and never reads past the end.
#include "net/osc/packets/validate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>

#include "base/random.h"
#include "net/osc/packets/decode.h"
#include "osc/bad_packets.h"

namespace limber::osc {
namespace {

using namespace test;

// Copies the bytes to an allocation of exact size, so that the sanitizer detects reads past the end.
const char* fault_of(const std::string& bytes) {
  const auto buffer = std::make_unique<char[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), buffer.get());
  return packet_fault(buffer.get(), bytes.size());
}

TEST(Validate, AcceptsValidPackets) {
  const std::vector<std::string> good = {
      Bytes().text("/a").str(),            // an old client without type tags
      Bytes().text("/a").text(",").str(),  // no arguments
      Bytes().text("/physics/part/mass").text(",ssf").text("quadruped").text("foot_1").f(0.25f).str(),
      Bytes().text("/a").text(",TFNI").str(),
      Bytes().text("/a").text(",i[ff]s").u32(1).f(2).f(3).text("x").str(),
      Bytes().text("/a").text(",[[i]]").u32(1).str(),
      Bytes().text("/a").text(",b").u32(3).raw(std::string("abc\0", 4)).str(),
      Bytes().text("/a").text(",b").u32(0).str(),
      Bytes().text("/a").text(",hdt").u64(1).d(2).u64(3).str(),
      Bytes().text("/a").text(",crmS").u32('x').u32(2).u32(3).text("sym").str(),
      Bytes().text("/a").text(",s").text("").str(),
      Bytes().text("/a*{b,c}[d-e]?//f").text(",f").f(1).str(),
      Bytes().text("/a").text(",i").u32(1).u32(99).str(),  // more data than tags: ignored
      bundle(1, {}),
      bundle(1, {numbered(1), bundle(1, {numbered(2)})}),
      nested(8),
      Bytes().text("/a").text("," + std::string(4096, 'T')).str(),
      Bytes().text("/a").text(",s").text(std::string(1024, 'x')).str(),
  };
  for (const std::string& bytes : good) EXPECT_EQ(fault_of(bytes), nullptr) << testing::PrintToString(bytes);
}

TEST(Validate, RejectsMalformedPackets) {
  for (const BadPacket& bad : bad_packets()) EXPECT_NE(fault_of(bad.bytes), nullptr) << bad.description;
}

TEST(Validate, ReportsReason) {
  EXPECT_STREQ(fault_of(from_hex("2f610000 2c626200 7fffff00")), "a blob larger than its message");
  EXPECT_STREQ(fault_of(from_hex("2362756e646c6500 0000000000000001 fffffffc")),
               "a bundle's element is larger than the bundle");
  EXPECT_STREQ(fault_of(from_hex("2f610000 3f800000")), "arguments without type tags");
  EXPECT_STREQ(fault_of(from_hex("2f610000 2c5d5b69 00000000 00000007")), "unbalanced arrays");
  EXPECT_STREQ(fault_of(nested(9)), "bundles nested deeper than 8");
}

// Each prefix of a valid packet is either complete or rejected, and never read past its end.
TEST(Validate, HandlesTruncatedPackets) {
  const std::string whole = bundle(
      1, {Bytes().text("/ab").text(",s[f]b").text("name").f(1).u32(5).raw("abcde").raw(std::string(3, '\0')).str(),
          numbered(7)});
  ASSERT_EQ(fault_of(whole), nullptr);
  std::set<std::size_t> passed;
  for (std::size_t n = 0; n < whole.size(); n++) {
    if (fault_of(whole.substr(0, n)) == nullptr) passed.insert(n);
  }
  // the bundle without elements, and with the first: 4 + 8 + 8 + 4 + 4 + 8
  const std::size_t first = 16 + 4 + (4 + 8 + 8 + 4 + 4 + 8);
  EXPECT_EQ(passed, (std::set<std::size_t>{16, first}));
}

// Accepted packets can be decoded: the validator is at least as strict as the decoder.
TEST(Validate, IsAsStrictAsDecoder) {
  Random random(7);
  const std::string seeds[] = {
      Bytes().text("/physics/part/mass").text(",ssf").text("quadruped").text("foot_1").f(0.25f).str(),
      Bytes().text("/a").text(",i[ff]sTb").u32(1).f(2).f(3).text("x").u32(4).raw("abcd").str(),
      bundle(1, {numbered(1), bundle(1, {numbered(2)}), Bytes().text("/a").str()}),
  };
  int passed = 0;
  for (int i = 0; i < 200000; i++) {
    std::string bytes = seeds[i % 3];
    for (std::uint64_t k = random.next() % 3; k < 3; k++) {
      const std::uint64_t r = random.next();
      bytes[r % bytes.size()] = (r >> 40) % 2 == 0 ? static_cast<char>(r >> 32) : "\0,[]bsTi/#"[(r >> 48) % 10];
    }
    if (fault_of(bytes) != nullptr) continue;
    passed++;
    EXPECT_TRUE(decode_packet(bytes.data(), bytes.size()).ok()) << testing::PrintToString(bytes);
  }
  EXPECT_GT(passed, 1000);
}

// Packets known to crash or hang decoders, if the files are available; two of them are valid messages.
TEST(Validate, RejectsKnownBadPackets) {
  const std::filesystem::path folder = std::string(LIMBER_SOURCE_DIR) + "/../shared/data/osc_bad";
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const bool whole = entry.path().stem() == "r9_empty_typetags";
    EXPECT_EQ(fault_of(bytes) == nullptr, whole) << entry.path();
  }
}

}  // namespace
}  // namespace limber::osc
