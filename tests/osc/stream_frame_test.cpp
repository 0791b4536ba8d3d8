// Stream frames: the exact bytes of hand-made snapshots, compared with a writer based only on the specification.
#include "net/osc/stream_frame.h"

#include <gtest/gtest.h>

#include "net/osc/packets/decode.h"
#include "net/osc/packets/validate.h"
#include "osc/osc_test_tools.h"
#include "osc/stream_test_world.h"

namespace limber::osc {
namespace {

using namespace test;

std::vector<std::string> datagrams(const StreamFrame& frame) {
  std::vector<std::string> list;
  std::size_t at = 0;
  for (const std::uint32_t size : frame.datagram_sizes()) {
    list.emplace_back(frame.bytes().data() + at, size);
    at += size;
  }
  EXPECT_EQ(at, frame.bytes().size());
  return list;
}

std::vector<std::string> framed(const engine::Snapshot& snapshot, const StreamTarget& target) {
  StreamFrame frame(kTestOffsets);
  frame.lay_out(snapshot.body_list, target);
  frame.fill(snapshot);
  return datagrams(frame);
}

// Returns the expected message of one stream and body, computed from the rule for the numbers.
std::string message(const char* stream, const engine::Snapshot& s, std::size_t body) {
  const engine::BodyEntry& b = s.body_list->bodies[body];
  const std::string name = stream;
  const std::uint32_t offset = name == "pos" ? 1 : name == "rot" ? 4 : name == "relrot" ? 9 : 13;
  const std::uint32_t width = name == "rot" ? 4 : 3;
  Bytes bytes;
  bytes.text("/physics/joint/" + name).text(",s" + std::string(b.joint_offsets.size() * width, 'f')).text(b.name);
  for (const std::uint32_t joint : b.joint_offsets) {
    for (std::uint32_t k = 0; k < width; k++) bytes.f(static_cast<float>(test_number(joint + offset + k)));
  }
  return bytes.str();
}

TEST(StreamFrame, SendsOneMessagePerDatagram) {
  const engine::Snapshot s = test_world({{"arm", 2}, {"leg", 1}});
  EXPECT_EQ(framed(s, {}),
            (std::vector<std::string>{message("pos", s, 0), message("pos", s, 1), message("rot", s, 0),
                                      message("rot", s, 1), message("relrot", s, 0), message("relrot", s, 1)}));
}

// The expected bytes written out: one joint at (1, 2, 3).
TEST(StreamFrame, WritesExactBytes) {
  engine::Snapshot s = test_world({{"a", 1}});
  s.transient.assign(s.transient.size(), 0);
  s.transient[s.body_list->bodies[0].joint_offsets[0] + kTestOffsets.joint_position] = 1;
  s.transient[s.body_list->bodies[0].joint_offsets[0] + kTestOffsets.joint_position + 1] = 2;
  s.transient[s.body_list->bodies[0].joint_offsets[0] + kTestOffsets.joint_position + 2] = 3;
  StreamTarget target;
  target.rot = target.relrot = false;
  const std::string expected("/physics/joint/pos\0\0,sfff\0\0\0a\0\0\0\x3f\x80\0\0\x40\0\0\0\x40\x40\0\0", 44);
  EXPECT_EQ(framed(s, target), std::vector<std::string>{expected});
}

TEST(StreamFrame, ContainsConfiguredStreams) {
  const engine::Snapshot s = test_world({{"arm", 3}});
  StreamTarget target;
  target.pos = target.rot = target.relrot = false;
  EXPECT_TRUE(framed(s, target).empty());
  target.relpos = true;
  EXPECT_EQ(framed(s, target), std::vector<std::string>{message("relpos", s, 0)});
  target.rot = true;
  EXPECT_EQ(framed(s, target), (std::vector<std::string>{message("rot", s, 0), message("relpos", s, 0)}));
}

TEST(StreamFrame, SelectsBodiesByPattern) {
  const engine::Snapshot s = test_world({{"arm1", 1}, {"box", 0}, {"leg", 2}, {"arm2", 1}});
  StreamTarget target;
  target.rot = target.relrot = false;
  EXPECT_EQ(framed(s, target),
            (std::vector<std::string>{message("pos", s, 0), message("pos", s, 2), message("pos", s, 3)}));
  target.bodies = "arm*";
  EXPECT_EQ(framed(s, target), (std::vector<std::string>{message("pos", s, 0), message("pos", s, 3)}));
  target.bodies = "leg";
  EXPECT_EQ(framed(s, target), std::vector<std::string>{message("pos", s, 2)});
  target.bodies = "box";
  EXPECT_TRUE(framed(s, target).empty());
}

// 17 joints, names of six letters: 288, 372 and 292 bytes. A bundle of 1472 bytes holds four, three and four messages;
// the last messages of a stream share a bundle with the first ones of the next.
TEST(StreamFrame, BundlesContainWholeMessages) {
  std::vector<FakeBody> bodies(9);
  for (std::size_t i = 0; i < bodies.size(); i++) bodies[i] = {"body_" + std::to_string(i), 17};
  const engine::Snapshot s = test_world(bodies);
  StreamTarget target;
  target.bundle = 1472;
  std::vector<std::string> pos, rot, relrot;
  for (std::size_t i = 0; i < 9; i++) {
    pos.push_back(message("pos", s, i));
    rot.push_back(message("rot", s, i));
    relrot.push_back(message("relrot", s, i));
  }
  EXPECT_EQ(pos[0].size(), 288u);
  EXPECT_EQ(rot[0].size(), 372u);
  EXPECT_EQ(relrot[0].size(), 292u);
  // 16 + 4 (4 + 288) = 1184; 16 + 292 + 3 · 376 = 1436; 16 + 3 · 376 + 296 = 1440; 16 + 4 · 296 = 1200
  EXPECT_EQ(framed(s, target),
            (std::vector<std::string>{
                bundle(1, {pos[0], pos[1], pos[2], pos[3]}), bundle(1, {pos[4], pos[5], pos[6], pos[7]}),
                bundle(1, {pos[8], rot[0], rot[1], rot[2]}), bundle(1, {rot[3], rot[4], rot[5]}),
                bundle(1, {rot[6], rot[7], rot[8], relrot[0]}), bundle(1, {relrot[1], relrot[2], relrot[3], relrot[4]}),
                bundle(1, {relrot[5], relrot[6], relrot[7], relrot[8]})}));
}

// Without a configured bundle size: single messages for up to 20 bodies, otherwise bundles of at most 1472 bytes.
TEST(StreamFrame, BundlesMoreThanTwentyBodies) {
  std::vector<FakeBody> bodies = {{"still", 0}};
  for (int i = 0; i < 20; i++) bodies.push_back({"b" + std::to_string(i), 4});
  EXPECT_EQ(framed(test_world(bodies), {}).size(), 60u);
  bodies.push_back({"b20", 4});
  const std::vector<std::string> list = framed(test_world(bodies), {});
  std::size_t messages = 0;
  for (const std::string& d : list) {
    EXPECT_LE(d.size(), 1472u);
    ASSERT_EQ(packet_fault(d.data(), d.size()), nullptr);
    messages += decode_packet(d.data(), d.size())->messages.size();
  }
  EXPECT_EQ(messages, 63u);
  EXPECT_LT(list.size(), 21u);
  StreamTarget off;
  off.bundle = 0;
  EXPECT_EQ(framed(test_world(bodies), off).size(), 63u);
}

// A message larger than the bundle limit is sent alone and without a bundle header.
TEST(StreamFrame, SendsLargeBodiesAlone) {
  const engine::Snapshot s = test_world({{"a", 3}, {"worm", 200}, {"b", 3}});
  StreamTarget target;
  target.bundle = 1472;
  target.rot = target.relrot = false;
  EXPECT_EQ(framed(s, target),
            (std::vector<std::string>{message("pos", s, 0), message("pos", s, 1), message("pos", s, 2)}));
}

// pos of n joints: 20 + padded(3 + 3 n) + 8 + 12 n bytes with this name; a datagram holds at most 4364.
TEST(StreamFrame, ReportsTooLargeBodies) {
  const engine::Snapshot s = test_world({{"huge", 4400}, {"a", 1}});
  StreamFrame frame(kTestOffsets);
  StreamTarget target;
  target.rot = target.relrot = false;
  frame.lay_out(s.body_list, target);
  frame.fill(s);
  EXPECT_EQ(datagrams(frame), std::vector<std::string>{message("pos", s, 1)});
  EXPECT_EQ(frame.too_large(), std::vector<std::string>{"huge"});
  const engine::Snapshot fits = test_world({{"huge", 4364}});
  frame.lay_out(fits.body_list, target);
  frame.fill(fits);
  ASSERT_EQ(datagrams(frame).size(), 1u);
  EXPECT_LE(datagrams(frame)[0].size(), 65504u);
  EXPECT_GT(datagrams(frame)[0].size() + 15, 65504u);
}

// The same layout is filled with the numbers of the next snapshot.
TEST(StreamFrame, UpdatesNumbersPerFrame) {
  engine::Snapshot s = test_world({{"arm", 2}});
  StreamFrame frame(kTestOffsets);
  frame.lay_out(s.body_list, {});
  frame.fill(s);
  const std::vector<std::string> first = datagrams(frame);
  for (double& v : s.transient) v += 1000;
  frame.lay_out(s.body_list, {});
  frame.fill(s);
  EXPECT_NE(datagrams(frame), first);
  const auto decoded = decode_packet(datagrams(frame)[0].data(), datagrams(frame)[0].size());
  EXPECT_EQ(decoded->messages.at(0).args.at(1).number, 1000 + test_number(s.body_list->bodies[0].joint_offsets[0] + 1));
}

TEST(StreamFrame, IsEmptyWithoutBodies) {
  StreamFrame frame(kTestOffsets);
  frame.lay_out(nullptr, {});
  frame.fill({});
  EXPECT_TRUE(frame.datagram_sizes().empty());
}

}  // namespace
}  // namespace limber::osc
