// The seed's 52 addresses from a client's bytes to the world: each numeric type, with and without names, by pattern, by
// path, in bundles; wrong ones are refused whole, counted and answered.
#include <algorithm>

#include <fmt/ranges.h>

#include "engine/seed_table.h"
#include "engine/show.h"
#include "osc/bytes.h"
#include "osc/decode.h"
#include "osc/validate.h"

namespace limber::osc_test {
namespace {

using engine_test::Address;
using engine_test::kByName;
using engine_test::kOfShapes;
using engine_test::Rig;
using engine_test::seed_address;
using engine_test::Show;
using Kind = Outcome::Kind;

const std::vector<std::string> kNoNames;
constexpr char kTags[] = {'i', 'h', 'f', 'd', 'T', 'F'};

// what this tag can say: whole numbers, fractions, truths
double said_by(char tag) { return tag == 'F' ? 0 : tag == 'f' || tag == 'd' ? 0.75 : 1; }

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
  EXPECT_TRUE(decoded.ok() && decoded->refused.empty());
  return decoded ? std::move(decoded->messages) : std::vector<Message>();
}

Outcome play(Rig& rig, const std::string& packet) {
  const std::vector<Message> messages = messages_of(packet);
  EXPECT_EQ(messages.size(), 1u);
  rig.dispatch.begin_tick();
  return rig.dispatch.execute(messages.front());
}

// what a row holds after a value was sent: truths where it has truths, its smallest where that is more
std::vector<double> taken(const Rig& rig, const std::string& path, double value, std::size_t width) {
  const Row& row = *find_place(rig.store, path)->row;
  const double number = row.type == RowType::flags3 ? (value >= 0.5 ? 1 : 0) : std::clamp(value, row.min, row.max);
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
    return fmt::format("/physics/body/{}/{}/{}/{}", body, a.of, element, a.row);
  };
  const auto rig = std::make_unique<Rig>();
  const std::vector<double> other = rig->read(path("1"));
  const Outcome outcome = play(*rig, packet_of(seed_address(a), form.names, tag, a.width));
  EXPECT_EQ(outcome.kind, Kind::applied) << outcome.error;
  const std::vector<double> wanted = taken(*rig, path("arm"), said_by(tag), a.width);
  EXPECT_EQ(rig->read(path("arm")), wanted);
  EXPECT_EQ(rig->read(path("1")), form.both_bodies ? wanted : other);
  // the same by path, which ends in the same row
  const auto twin = std::make_unique<Rig>();
  EXPECT_EQ(play(*twin, packet_of(path("arm"), kNoNames, tag, a.width)).kind, Kind::applied);
  EXPECT_EQ(twin->read(path("arm")), wanted);
}

TEST(SeedWire, EveryAddressByEveryTypeInEveryForm) {
  for (const Address& a : kByName) {
    const std::string element = std::string_view(a.of) == "part" ? "tip" : "shoulder";
    for (const char tag : kTags) {
      for (const Form& form : forms_of(element)) {
        SCOPED_TRACE(fmt::format("{} ,{} {}", seed_address(a), tag, fmt::join(form.names, " ")));
        check_form(a, element, tag, form);
      }
    }
  }
}

TEST(SeedWire, ShapesByEveryType) {
  for (const Address& a : kOfShapes) {
    for (const char tag : kTags) {
      SCOPED_TRACE(fmt::format("{} ,{}", seed_address(a), tag));
      Rig rig;
      const std::string path = fmt::format("/visuals/shape/ball/{}", a.row);
      const std::string other = fmt::format("/visuals/shape/ground/{}", a.row);
      const std::vector<double> before = rig.read(other);
      EXPECT_EQ(play(rig, packet_of(seed_address(a), {"ball"}, tag, a.width)).kind, Kind::applied);
      EXPECT_EQ(rig.read(path), std::vector<double>(a.width, said_by(tag)));
      EXPECT_EQ(rig.read(other), before);
    }
  }
}

TEST(SeedWire, TheOthersByEveryType) {
  for (const char tag : kTags) {
    SCOPED_TRACE(tag);
    const double v = said_by(tag);
    Rig rig;
    EXPECT_EQ(play(rig, packet_of("/physics/sim/gravity", {}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(rig.read("/physics/sim/gravity"), (std::vector<double>{0, 0, v}));
    EXPECT_EQ(play(rig, packet_of("/physics/sim/gravity", {}, tag, 3)).kind, Kind::applied);
    EXPECT_EQ(rig.read("/physics/sim/gravity"), (std::vector<double>{v, v, v}));
    EXPECT_EQ(play(rig, packet_of("/physics/sim/timestep", {}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(rig.read("/physics/sim/timestep")[0], std::max(v, 1e-5));
    EXPECT_EQ(play(rig, packet_of("/physics/sim/substeps", {}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(rig.read("/physics/sim/substeps")[0], 1);
    for (const char* address : {"/visuals/camera/position", "/visuals/camera/rotation"}) {
      EXPECT_EQ(play(rig, packet_of(address, {}, tag, 3)).kind, Kind::applied);
      EXPECT_EQ(rig.read(address), (std::vector<double>{v, v, v}));
    }
    EXPECT_EQ(play(rig, packet_of("/physics/part/force", {"arm", "tip"}, tag, 3)).kind, Kind::applied);
    ASSERT_TRUE(rig.world.behaviors().add(*rig.world.find_body("arm"), "force", "push").ok());
    EXPECT_EQ(play(rig, packet_of("/physics/behavior/parameter", {"push", "amp"}, tag, 1)).kind, Kind::applied);
    EXPECT_EQ(rig.read("/physics/body/arm/behavior/push/amp")[0], v);
    EXPECT_EQ(play(rig, packet_of("/physics/behavior/parameter", {"arm", "push", "active"}, tag, 1)).kind,
              Kind::applied);
    EXPECT_EQ(rig.read("/physics/body/arm/behavior/push/active")[0], v >= 0.5 ? 1 : 0);
  }
  Rig rig;
  EXPECT_EQ(
      play(rig, Bytes().text("/visuals/camera/projection").text(",ifdh").u32(40).f(1.5F).d(0.25).u64(90).str()).kind,
      Kind::applied);
  EXPECT_EQ(rig.read("/visuals/camera/far")[0], 90);
}

constexpr const char* kScene = R"(
local shape = sim:add_sphere_shape("ball", 0.1)
local arm = sim:add_body("arm")
arm:add_part("base", shape, { mass = 0, position = vec3(0, 0, 2) })
arm:add_part("tip", shape, { position = vec3(0, 0, 1) })
arm:add_motor(arm:add_joint("tip", "base", "tip", { position = vec3(0, 0, 2), axis = vec3(0, 1, 0) }))
)";

// wrong names, counts, types: nothing of it is applied, each is counted once and answered once
TEST(SeedWire, WhatIsWrongIsRefusedWholeCountedAndAnswered) {
  const engine_test::SceneFile file(kScene);
  Show show(file.path());
  show.ticks(1);
  show.outbox();
  std::uint64_t refused = 0;
  const auto wrong = [&](const std::string& packet) {
    const std::vector<double> before(show.engine.store().kept().begin(), show.engine.store().kept().end());
    show.link.inbox.push({messages_of(packet), {Hand::osc, 0x7f000001, 4000}});
    show.ticks(1);
    refused++;
    EXPECT_EQ(show.link.counters.refused.load(), refused);
    const std::vector<std::string> said = show.outbox();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(said[0].starts_with("/error ")) << said[0];
    EXPECT_EQ(std::vector<double>(show.engine.store().kept().begin(), show.engine.store().kept().end()), before);
  };
  const auto check = [&](const Address& a, std::size_t most_names) {
    SCOPED_TRACE(seed_address(a));
    const std::string address = seed_address(a);
    wrong(packet_of(address, {"nobody"}, 'f', a.width));
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
  for (const Address& a : kByName) check(a, 2);
  for (const Address& a : kOfShapes) check(a, 1);
  EXPECT_EQ(show.link.counters.unknown.load(), 0u);
  EXPECT_EQ(show.link.counters.clamped.load(), 0u);
}

}  // namespace
}  // namespace limber::osc_test
