// PacketWriter: the exact bytes of every type, nested bundles, and buffers that are too small.
#include "net/osc/packets/packet_writer.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "net/osc/packets/validate.h"
#include "osc/bytes.h"

namespace limber::osc {
namespace {

using namespace test;

std::string written(std::size_t size, const std::function<void(PacketWriter&)>& write) {
  // an allocation of exact size, so that the address sanitizer reports writes past the end
  const auto buffer = std::make_unique<char[]>(size);
  PacketWriter out(buffer.get(), size);
  write(out);
  return {out.packet().begin(), out.packet().end()};
}

void every_type(PacketWriter& out) {
  out.begin_message("/all", 19);
  out.int32(-7);
  out.int64(-(std::int64_t{1} << 40));
  out.float32(-1.5f);
  out.float64(0.1);
  out.boolean(true);
  out.boolean(false);
  out.nil();
  out.infinitum();
  out.string("arm");
  out.string("");
  out.symbol("four");
  out.character('q');
  out.color(0xff800001u);
  out.begin_array();
  out.midi(0x00903c7fu);
  out.end_array();
  out.time_tag(0x8000000000000001u);
  out.blob("abcde");
  out.blob("");
  out.end_message();
}

std::string every_type_bytes() {
  return Bytes()
      .text("/all")
      .text(",ihfdTFNIssScr[m]tbb")
      .u32(0xfffffff9u)
      .u64(0xffffff0000000000u)
      .f(-1.5f)
      .d(0.1)
      .text("arm")
      .text("")
      .text("four")
      .u32('q')
      .u32(0xff800001u)
      .u32(0x00903c7fu)
      .u64(0x8000000000000001u)
      .u32(5)
      .raw(std::string("abcde\0\0\0", 8))
      .u32(0)
      .str();
}

void write_nested(PacketWriter& out) {
  out.begin_bundle(77);
  out.begin_bundle(1);
  out.end_bundle();
  out.begin_bundle(99);
  every_type(out);
  out.begin_message("/b", 0);
  out.end_message();
  out.end_bundle();
  out.begin_message("/n", 1);
  out.int32(5);
  out.end_message();
  out.end_bundle();
}

std::string written_nested_bytes() {
  return bundle(77, {bundle(1, {}), bundle(99, {every_type_bytes(), Bytes().text("/b").text(",").str()}), numbered(5)});
}

TEST(PacketWriter, WritesEveryType) {
  EXPECT_EQ(written(1000, every_type), every_type_bytes());
  EXPECT_EQ(packet_fault(every_type_bytes().data(), every_type_bytes().size()), nullptr);
}

TEST(PacketWriter, WritesNestedBundles) { EXPECT_EQ(written(1000, write_nested), written_nested_bytes()); }

TEST(PacketWriter, RequiresExactPacketSize) {
  const std::size_t size = written_nested_bytes().size();
  EXPECT_EQ(written(size, write_nested), written_nested_bytes());
  for (std::size_t n = 0; n < size; n++) ASSERT_EQ(written(n, write_nested), "") << n;
}

TEST(PacketWriter, NestsToValidatorLimit) {
  const auto deep = [](int depth) {
    return [depth](PacketWriter& out) {
      for (int i = 0; i < depth; i++) out.begin_bundle(1);
      out.begin_message("/n", 0);
      out.end_message();
      for (int i = 0; i < depth; i++) out.end_bundle();
    };
  };
  const std::string eight = written(1000, deep(8));
  EXPECT_EQ(eight.size(), 8u * 20 - 4 + 4 + 8);
  EXPECT_EQ(packet_fault(eight.data(), eight.size()), nullptr);
  EXPECT_EQ(written(1000, deep(9)), "");
}

TEST(PacketWriter, RejectsCallsInTheWrongOrder) {
  const std::vector<std::function<void(PacketWriter&)>> wrong = {
      [](PacketWriter& out) { out.int32(1); },
      [](PacketWriter& out) { out.end_message(); },
      [](PacketWriter& out) { out.end_bundle(); },
      [](PacketWriter& out) { out.begin_message("/a", 0); },
      [](PacketWriter& out) { out.begin_bundle(1); },
      [](PacketWriter& out) {
        out.begin_message("/a", 1);
        out.end_message();
      },
      [](PacketWriter& out) {
        out.begin_message("/a", 0);
        out.nil();
        out.end_message();
      },
      [](PacketWriter& out) {
        out.begin_message("/a", 0);
        out.begin_message("/b", 0);
        out.end_message();
        out.end_message();
      },
      [](PacketWriter& out) {
        out.begin_bundle(1);
        out.begin_message("/a", 0);
        out.end_bundle();
        out.end_message();
      },
      // a packet is one message or one bundle
      [](PacketWriter& out) {
        for (int i = 0; i < 2; i++) {
          out.begin_message("/a", 0);
          out.end_message();
        }
      },
  };
  for (std::size_t i = 0; i < wrong.size(); i++) EXPECT_EQ(written(1000, wrong[i]), "") << i;
}

}  // namespace
}  // namespace limber::osc
