// Binary encoding of takes: round trips are exact, and repeated message headers are short.
#include "engine/takes/encoding.h"

#include <bit>
#include <cmath>
#include <limits>

#include "engine/rig.h"

namespace limber::engine::test {
namespace {

bool same_arg(const Arg& a, const Arg& b) {
  return a.kind == b.kind && a.text == b.text &&
         std::bit_cast<std::uint64_t>(a.number) == std::bit_cast<std::uint64_t>(b.number);
}

TEST(TakeText, NumbersRoundTripExactly) {
  std::string text;
  TakeEncoder out(text);
  InputCodec encoder;
  std::vector<double> numbers = {0,           -0.0,  1,       -1,    127,   128,
                                 -64,         1e9,   1e9 - 1, 0.5,   0.1,   double{0.1F},
                                 3e38,        1e300, 5e-324,  1e-40, -2e-7, std::numeric_limits<double>::infinity(),
                                 std::nan("")};
  for (const double v : numbers) encoder.encode(out, message("/a", v), {});
  TakeDecoder in(text);
  InputCodec decoder;
  for (const double v : numbers) {
    InputRecord m;
    ASSERT_TRUE(decoder.decode(in, m)) << v;
    ASSERT_EQ(m.message.args.size(), 1u);
    EXPECT_TRUE(same_arg(m.message.args[0], Arg::of(v))) << v;
  }
  EXPECT_TRUE(in.at_end());
}

TEST(TakeText, MessagesRoundTripWithSenders) {
  const std::vector<Message> messages = {message("/a", 1, "text", true, false, Arg{}),
                                         message("/a", "", std::string(300, 'x')), message("/bb")};
  const CommandOrigin origins[] = {{CommandSource::osc, 0x7f000001, 4000}, {CommandSource::panel, 0, 0}};
  std::string text;
  TakeEncoder out(text);
  InputCodec encoder;
  for (int i = 0; i < 3; i++) {
    for (const Message& m : messages) {
      for (const CommandOrigin& origin : origins) encoder.encode(out, m, origin);
    }
  }
  TakeDecoder in(text);
  InputCodec decoder;
  for (int i = 0; i < 3; i++) {
    for (const Message& m : messages) {
      for (const CommandOrigin& origin : origins) {
        InputRecord taken;
        ASSERT_TRUE(decoder.decode(in, taken));
        EXPECT_EQ(taken.message.address, m.address);
        EXPECT_EQ(taken.origin, origin);
        ASSERT_EQ(taken.message.args.size(), m.args.size());
        for (std::size_t k = 0; k < m.args.size(); k++) EXPECT_TRUE(same_arg(taken.message.args[k], m.args[k]));
      }
    }
  }
  EXPECT_TRUE(in.at_end());
}

TEST(TakeText, WritesMessageHeadersOnce) {
  std::string text;
  TakeEncoder out(text);
  InputCodec encoder;
  const Message sent = message("/physics/body/arm1/motor/m/target", double{0.3F});
  encoder.encode(out, sent, {});
  const std::size_t first = text.size();
  encoder.encode(out, sent, {});
  EXPECT_EQ(text.size() - first, 5u) << "the number of the header, and a float";
}

TEST(TakeText, TicksRoundTrip) {
  RecordedPass tick;
  tick.running = true;
  tick.runs = {{TakeSceneRun::Kind::scene, true, false, 3, "other.lua"},
               {TakeSceneRun::Kind::rerun, false, true, 0, ""}};
  tick.stopped_calls = {{12, "scripts/a.lua", 7, "stopped"}};
  tick.tick = 100000;
  tick.motion_hash = 0xfedcba9876543210u;
  tick.state_hash = 5;
  tick.first_body = 32;
  tick.body_hashes = {1, 65535};
  InputLog log;
  log.record(message("/a", 1), {}, false);
  std::string text;
  log.append_pass(text, tick);
  EXPECT_TRUE(log.empty());
  RecordedPass again;
  InputCodec decoder;
  ASSERT_TRUE(read_pass(text, decoder, again));
  ASSERT_EQ(again.runs.size(), 2u);
  EXPECT_EQ(again.runs[0].scene, "other.lua");
  EXPECT_TRUE(again.runs[0].succeeded && !again.runs[1].succeeded && again.runs[1].reuses_files);
  EXPECT_EQ(again.messages.size(), 1u);
  ASSERT_EQ(again.stopped_calls.size(), 1u);
  EXPECT_EQ(again.stopped_calls[0].number, 12u);
  EXPECT_EQ(again.stopped_calls[0].line, 7);
  EXPECT_EQ(again.tick, tick.tick);
  EXPECT_EQ(again.motion_hash, tick.motion_hash);
  EXPECT_EQ(again.state_hash, tick.state_hash);
  EXPECT_EQ(again.body_hashes, tick.body_hashes);
  for (std::size_t size = 0; size < text.size(); size++) {
    InputCodec fresh;
    EXPECT_FALSE(read_pass(text.substr(0, size), fresh, again)) << size;
  }
}

TEST(TakeText, SendersHaveAddressesOfBothKinds) {
  const CommandOrigin senders[] = {{CommandSource::osc, 0x0a000001U, 9000},
                                   {CommandSource::oscquery, system::IpAddress(0xfe80ULL << 48U, 1, 3), 9001},
                                   {CommandSource::osc, system::IpAddress(0, 0x0a000001U), 9000},
                                   {CommandSource::midi}};
  std::string text;
  TakeEncoder out(text);
  InputCodec encoder;
  for (int round = 0; round < 2; round++) {
    for (const CommandOrigin& sender : senders) encoder.encode(out, message("/a", 1), sender);
  }
  TakeDecoder in(text);
  InputCodec decoder;
  for (int round = 0; round < 2; round++) {
    for (const CommandOrigin& sender : senders) {
      InputRecord record;
      ASSERT_TRUE(decoder.decode(in, record));
      EXPECT_EQ(record.origin, sender);
      EXPECT_EQ(record.message.address, "/a");
      EXPECT_EQ(record.message.args.size(), 1u);
    }
  }
  EXPECT_TRUE(in.at_end());
}

TEST(TakeText, ReadingATickReplacesThePreviousOne) {
  InputLog log;
  InputCodec decoder;
  const auto bytes = [&](const RecordedPass& tick, const std::vector<Message>& messages) {
    for (const Message& m : messages) log.record(m, {}, false);
    std::string text;
    log.append_pass(text, tick);
    return text;
  };
  RecordedPass full;
  full.running = true;
  full.runs = {{TakeSceneRun::Kind::scene, true, false, 3, "other.lua"}};
  full.stopped_calls = {{12, "a.lua", 7, "stopped"}};
  full.state_hash = 5;
  full.first_body = 32;
  full.body_hashes = {1, 2};
  RecordedPass tick;
  // console input has no address
  ASSERT_TRUE(read_pass(bytes(full, {message("", "sim.time"), message("/a", "x", 2), message("/b")}), decoder, tick));
  ASSERT_EQ(tick.messages.size(), 3U);
  EXPECT_TRUE(tick.messages[0].evaluate);
  EXPECT_EQ(tick.messages[0].message.address, "sim.time");
  ASSERT_TRUE(read_pass(bytes({}, {message("/b", 1), message("/a", 1)}), decoder, tick));
  ASSERT_EQ(tick.messages.size(), 2U);
  EXPECT_FALSE(tick.messages[0].evaluate);
  EXPECT_EQ(tick.messages[0].message.address, "/b");
  ASSERT_EQ(tick.messages[1].message.args.size(), 1U);
  EXPECT_TRUE(same_arg(tick.messages[1].message.args[0], Arg::of(1.0)));
  EXPECT_FALSE(tick.running || tick.state_hash);
  EXPECT_TRUE(tick.runs.empty() && tick.stopped_calls.empty() && tick.body_hashes.empty());
  EXPECT_EQ(tick.first_body, 0U);
  ASSERT_TRUE(read_pass(bytes({}, {}), decoder, tick));
  EXPECT_TRUE(tick.messages.empty());
}

TEST(InputLog, WithoutHeaderTableDecodesFromAnyPass) {
  InputLog log(0);
  std::vector<std::string> passes(2);
  for (std::string& text : passes) {
    log.record(message("/a", 1), {}, false);
    log.record({"sim.time", {}}, {}, true);
    log.append_pass(text, {});
  }
  InputCodec decoder(0);
  for (const std::string& text : {passes[1], passes[0], passes[1]}) {
    RecordedPass pass;
    ASSERT_TRUE(read_pass(text, decoder, pass));
    ASSERT_EQ(pass.messages.size(), 2U);
    EXPECT_EQ(pass.messages[0].message.address, "/a");
    EXPECT_TRUE(pass.messages[1].evaluate);
    EXPECT_EQ(pass.messages[1].message.address, "sim.time");
  }
}

TEST(TakeText, RejectsNewerVersions) {
  TakeHeader header;
  header.scene = "a \"b\".lua";
  const std::string text = header_text(header);
  const std::size_t line = text.find('\n');
  const Result<TakeHeader> read = header_of(text.substr(0, line), text.substr(line + 1));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->scene, header.scene);
  const Result<TakeHeader> newer = header_of(fmt::format("limber take {}", kTakeVersion + 1), "{}");
  ASSERT_FALSE(newer.ok());
  EXPECT_NE(newer.error().find(fmt::format("version {}", kTakeVersion + 1)), std::string::npos);
  EXPECT_FALSE(header_of("limber presets 1", "{}").ok());
  EXPECT_FALSE(header_of("limber take 1", "nothing").ok());
}

}  // namespace
}  // namespace limber::engine::test
