// The 52 ofxDabPhysics addresses from a client's bytes to the world: each numeric type, with and without names, by
// pattern, by path, in bundles. Invalid messages are rejected as a whole, counted and answered.
#include <algorithm>

#include <fmt/ranges.h>

#include "engine/seed_table.h"
#include "engine/show.h"
#include "net/osc/packets/decode.h"
#include "net/osc/packets/validate.h"
#include "osc/bytes.h"
#include "support/skip.h"

namespace limber::osc::test {
namespace {

using engine::test::Address;
using engine::test::kElementAddresses;
using engine::test::kShapeAddresses;
using engine::test::legacy_address;
using engine::test::Rig;
using engine::test::Show;
using Kind = engine::Outcome::Kind;

const std::vector<std::string> kNoNames;
constexpr char kTags[] = {'i', 'h', 'f', 'd', 'T', 'F'};

// Returns the value sent with this type tag: an integer, a fraction or a boolean.
double value_of_tag(char tag) { return tag == 'F' ? 0 : tag == 'f' || tag == 'd' ? 0.75 : 1; }

void write(Bytes& bytes, char tag) {
  if (tag == 'i') bytes.u32(1);
  if (tag == 'h') bytes.u64(1);
  if (tag == 'f') bytes.f(0.75F);
  if (tag == 'd') bytes.d(0.75);
}

std::string packet_of(const std::string& address, const std::vector<std::string>& names, char tag, std::size_t width) {
  Bytes bytes;
  bytes.text(address).text("," + std::string(names.size(), 's') + std::string(width, tag));
  for (const std::string& name : names) bytes.text(name);
  for (std::size_t i = 0; i < width; i++) write(bytes, tag);
  return bytes.str();
}

std::vector<Message> messages_of(const std::string& packet) {
  EXPECT_EQ(packet_fault(packet.data(), packet.size()), nullptr);
  Result<Decoded> decoded = decode_packet(packet.data(), packet.size());
  EXPECT_TRUE(decoded.ok() && decoded->rejected.empty());
  return decoded ? std::move(decoded->messages) : std::vector<Message>();
}

engine::Outcome play(Rig& fixture, const std::string& packet) {
  const std::vector<Message> messages = messages_of(packet);
  EXPECT_EQ(messages.size(), 1u);
  fixture.dispatcher.begin_pass();
  return fixture.dispatcher.execute(messages.front());
}

// Returns the expected property after this value was sent: converted to booleans or clamped to the range.
std::vector<double> expected_value(const Rig& fixture, const std::string& path, double value, std::size_t width) {
  const Property& property = *find_property(fixture.store, path)->property;
  const double number =
      property.type == PropertyType::flags3 ? (value >= 0.5 ? 1 : 0) : std::clamp(value, property.min, property.max);
  return std::vector<double>(width, number);
}

struct Form {
  std::vector<std::string> names;
  bool both_bodies;
};

std::vector<Form> forms_of(const std::string& element) {
  return {{{}, true},      {{"arm"}, false},         {{element}, true}, {{"arm", element}, false},
          {{"a*"}, false}, {{"{arm,1}", "?*"}, true}};
}

void check_form(const Address& a, const std::string& element, char tag, const Form& form) {
  const auto path = [&](const char* body) {
    return fmt::format("/physics/body/{}/{}/{}/{}", body, a.class_name, element, a.property);
  };
  const auto fixture = std::make_unique<Rig>();
  const std::vector<double> other = fixture->read(path("1"));
  const engine::Outcome outcome = play(*fixture, packet_of(legacy_address(a), form.names, tag, a.width));
  EXPECT_EQ(outcome.kind, Kind::applied) << outcome.error;
  const std::vector<double> wanted = expected_value(*fixture, path("arm"), value_of_tag(tag), a.width);
  EXPECT_EQ(fixture->read(path("arm")), wanted);
  EXPECT_EQ(fixture->read(path("1")), form.both_bodies ? wanted : other);
  // the modern path sets the same property
  const auto twin = std::make_unique<Rig>();
  EXPECT_EQ(play(*twin, packet_of(path("arm"), kNoNames, tag, a.width)).kind, Kind::applied);
  EXPECT_EQ(twin->read(path("arm")), wanted);
}

TEST(LegacyWire, EveryAddressByEveryTypeInEveryForm) {
  LIMBER_SKIP_IF(kThreadSanitizer, "it uses one thread");
  for (const Address& a : kElementAddresses) {
    const std::string element = std::string_view(a.class_name) == "part" ? "tip" : "shoulder";
    for (const char tag : kTags) {
      for (const Form& form : forms_of(element)) {
        SCOPED_TRACE(fmt::format("{} ,{} {}", legacy_address(a), tag, fmt::join(form.names, " ")));
        check_form(a, element, tag, form);
      }
    }
  }
}

TEST(LegacyWire, ShapesByEveryType) {
  for (const Address& a : kShapeAddresses) {
    for (const char tag : kTags) {
      SCOPED_TRACE(fmt::format("{} ,{}", legacy_address(a), tag));
      Rig fixture;
      const std::string path = fmt::format("/visuals/shape/ball/{}", a.property);
      const std::string other = fmt::format("/visuals/shape/ground/{}", a.property);
      const std::vector<double> before = fixture.read(other);
      EXPECT_EQ(play(fixture, packet_of(legacy_address(a), {"ball"}, tag, a.width)).kind, Kind::applied);
      EXPECT_EQ(fixture.read(path), std::vector<double>(a.width, value_of_tag(tag)));
      EXPECT_EQ(fixture.read(other), before);
    }
  }
}

TEST(LegacyWire, OtherAddressesByEveryType) {
  for (const char tag : kTags) {
    SCOPED_TRACE(tag);
    const double v = value_of_tag(tag);
    Rig fixture;
    EXPECT_EQ(play(fixture, packet_of("/physics/sim/gravity", {}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(fixture.read("/physics/sim/gravity"), (std::vector<double>{0, 0, v}));
    EXPECT_EQ(play(fixture, packet_of("/physics/sim/gravity", {}, tag, 3)).kind, Kind::applied);
    EXPECT_EQ(fixture.read("/physics/sim/gravity"), (std::vector<double>{v, v, v}));
    EXPECT_EQ(play(fixture, packet_of("/physics/sim/timestep", {}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(fixture.read("/physics/sim/timestep")[0], std::max(v, 1e-5));
    EXPECT_EQ(play(fixture, packet_of("/physics/sim/substeps", {}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(fixture.read("/physics/sim/substeps")[0], 1);
    for (const char* address : {"/visuals/camera/position", "/visuals/camera/rotation"}) {
      EXPECT_EQ(play(fixture, packet_of(address, {}, tag, 3)).kind, Kind::applied);
      EXPECT_EQ(fixture.read(address), (std::vector<double>{v, v, v}));
    }
    EXPECT_EQ(play(fixture, packet_of("/physics/part/force", {"arm", "tip"}, tag, 3)).kind, Kind::applied);
    ASSERT_TRUE(fixture.world.behaviors().add(*fixture.world.find_body("arm"), "force", "push").ok());
    EXPECT_EQ(play(fixture, packet_of("/physics/behavior/parameter", {"push", "amp"}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(fixture.read("/physics/body/arm/behavior/push/amp")[0], v);
    EXPECT_EQ(play(fixture, packet_of("/physics/behavior/parameter", {"arm", "push", "active"}, tag, 1)).kind,
              Kind::applied);
    EXPECT_EQ(fixture.read("/physics/body/arm/behavior/push/active")[0], v >= 0.5 ? 1 : 0);
  }
  Rig fixture;
  EXPECT_EQ(
      play(fixture, Bytes().text("/visuals/camera/projection").text(",ifdh").u32(40).f(1.5F).d(0.25).u64(90).str())
          .kind,
      Kind::applied);
  EXPECT_EQ(fixture.read("/visuals/camera/far")[0], 90);
}

constexpr const char* kScene = R"(
local shape = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", shape, { mass = 0, position = vec3(0, 0, 2) })
arm:add_part("tip", shape, { position = vec3(0, 0, 1) })
arm:add_motor(arm:add_joint("tip", "base", "tip", { position = vec3(0, 0, 2), axis = vec3(0, 1, 0) }))
)";

// Wrong names, argument counts and types: nothing is applied, each message is counted once and answered once.
TEST(LegacyWire, RejectsInvalidMessages) {
  const engine::test::SceneFile file(kScene);
  Show show(file.path());
  show.ticks(1);
  show.sent_texts();
  std::uint64_t rejected = 0;
  const auto wrong = [&](const std::string& packet) {
    const std::vector<double> before(show.engine.store().persistent_values().begin(),
                                     show.engine.store().persistent_values().end());
    show.link.command_queue.push({messages_of(packet), {CommandSource::osc, 0x7f000001, 4000}});
    show.ticks(1);
    rejected++;
    EXPECT_EQ(show.link.counters.refused.load(), rejected);
    const std::vector<std::string> replies = show.sent_texts();
    ASSERT_EQ(replies.size(), 1u);
    EXPECT_TRUE(replies[0].starts_with("/error ")) << replies[0];
    EXPECT_EQ(std::vector<double>(show.engine.store().persistent_values().begin(),
                                  show.engine.store().persistent_values().end()),
              before);
  };
  const auto check = [&](const Address& a, std::size_t most_names) {
    SCOPED_TRACE(legacy_address(a));
    const std::string address = legacy_address(a);
    wrong(packet_of(address, {"missing"}, 'f', a.width));
    wrong(packet_of(address, {"no*"}, 'f', a.width));
    wrong(packet_of(address, std::vector<std::string>(most_names + 1, "arm"), 'f', a.width));
    wrong(packet_of(address, {}, 'f', 0));
    wrong(packet_of(address, {}, 'f', a.width + 3));
    if (a.width == 3) wrong(packet_of(address, {}, 'f', 2));
    wrong(Bytes().text(address).text("," + std::string(a.width, 'N')).str());
    Bytes infinite;
    infinite.text(address).text("," + std::string(a.width, 'f'));
    for (std::size_t i = 0; i < a.width; i++) infinite.u32(0x7f800000u);
    wrong(infinite.str());
  };
  for (const Address& a : kElementAddresses) check(a, 2);
  for (const Address& a : kShapeAddresses) check(a, 1);
  EXPECT_EQ(show.link.counters.unknown.load(), 0u);
  EXPECT_EQ(show.link.counters.clamped.load(), 0u);
}

}  // namespace
}  // namespace limber::osc::test
