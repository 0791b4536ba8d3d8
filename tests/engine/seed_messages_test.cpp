// The physics messages of ofxDabPhysics: every address in every form, with its effect read from the store.
#include <algorithm>
#include <map>
#include <set>

#include "base/text.h"
#include "engine/rig.h"
#include "engine/seed_table.h"

namespace limber::engine::test {
namespace {

using Values = std::vector<double>;
using Kind = Outcome::Kind;

Values value_of(const Address& a) {
  if (a.flags) return {1, 0, 1};
  return a.width == 1 ? Values{0.25} : Values{0.25, 0.5, 0.75};
}

const std::map<std::string, std::vector<std::pair<std::string, std::string>>> kElements = {
    {"part",
     {{"arm", "base"},
      {"arm", "upper"},
      {"arm", "lower"},
      {"arm", "tip"},
      {"1", "base"},
      {"1", "tip"},
      {"floor", "floor"}}},
    {"joint", {{"arm", "shoulder"}, {"arm", "elbow"}, {"arm", "slide"}, {"1", "shoulder"}}},
    {"motor", {{"arm", "shoulder"}, {"arm", "elbow"}, {"arm", "slide"}, {"1", "shoulder"}}},
};

bool is_static(const std::string& element) { return element == "base" || element == "floor"; }

// the names at the start of a message, and the elements that they select
struct Form {
  std::vector<Arg> names;
  bool (*targets)(const std::string& of, const std::string& body, const std::string& element);
};

using S = const std::string&;
const Form kForms[] = {
    {{}, [](S, S, S) { return true; }},
    {{arg("arm")}, [](S, S body, S) { return body == "arm"; }},
    {{arg("1")}, [](S, S body, S) { return body == "1"; }},
    {{arg(1)}, [](S, S body, S) { return body == "1"; }},
    {{arg("shoulder")}, [](S of, S, S element) { return of != "part" && element == "shoulder"; }},
    {{arg("tip")}, [](S of, S, S element) { return of == "part" && element == "tip"; }},
    {{arg("arm"), arg("elbow")}, [](S of, S body, S e) { return of != "part" && body == "arm" && e == "elbow"; }},
    {{arg("arm"), arg("upper")}, [](S of, S body, S e) { return of == "part" && body == "arm" && e == "upper"; }},
    {{arg("a*")}, [](S, S body, S) { return body == "arm"; }},
    {{arg("[0-9]"), arg("*")}, [](S, S body, S) { return body == "1"; }},
    {{arg("*"), arg("{tip,shoulder}")}, [](S, S, S e) { return e == "tip" || e == "shoulder"; }},
    {{arg("?rm"), arg("*e*")}, [](S, S body, S e) { return body == "arm" && e.find('e') != std::string::npos; }},
};

// notations of numbers; int, float and double are already converted to numbers here
enum class Notation { numbers, booleans, text };

std::optional<Arg> format_value(double v, Notation notation) {
  if (notation == Notation::text) return arg(number_text(v));
  if (notation == Notation::numbers) return arg(v);
  return v == 0 || v == 1 ? std::optional(arg(v != 0)) : std::nullopt;
}

std::string path_of(const Address& a, const std::string& body, const std::string& element) {
  return fmt::format("/physics/body/{}/{}/{}/{}", body, a.class_name, element, a.property);
}

void check_form(Rig& rig, const Address& a, const Form& form, Notation notation) {
  Message m{legacy_address(a), form.names};
  for (const double v : value_of(a)) {
    const auto value = format_value(v, notation);
    if (!value) return;
    m.args.push_back(*value);
  }
  std::map<std::string, Values> before;
  std::map<std::string, Values> expected;
  bool any = false;
  for (const auto& [body, element] : kElements.at(a.class_name)) {
    const std::string path = path_of(a, body, element);
    const bool skipped = std::string_view(a.address) == "mass" && is_static(element);
    const bool selected = form.targets(a.class_name, body, element) && !skipped;
    before[path] = rig.read(path);
    expected[path] = selected ? value_of(a) : before[path];
    any = any || selected;
  }
  rig.dispatcher.begin_pass();
  const Outcome outcome = rig.dispatcher.execute(m);
  EXPECT_EQ(outcome.kind, any ? Kind::applied : Kind::rejected) << outcome.error;
  EXPECT_EQ(outcome.sets_override, any);
  EXPECT_EQ(outcome.clamped, nullptr);
  for (const auto& [path, values] : expected) {
    EXPECT_EQ(rig.read(path), values) << path;
    // restore the value for the next form; the mass of a static part can't be set
    if (before[path] == values) continue;
    const PropertyRef ref = find_property(rig.store, path).value();
    ASSERT_TRUE(rig.store.set(ref.node, *ref.property, before[path]).ok());
  }
}

TEST(LegacyMessages, AcceptsEveryAddressInEveryForm) {
  Rig rig;
  for (const Address& a : kElementAddresses) {
    for (std::size_t f = 0; f < std::size(kForms); f++) {
      for (const Notation how : {Notation::numbers, Notation::booleans, Notation::text}) {
        SCOPED_TRACE(fmt::format("{} form {} written {}", legacy_address(a), f, static_cast<int>(how)));
        check_form(rig, a, kForms[f], how);
      }
    }
  }
}

TEST(LegacyMessages, NamesIgnoreCaseAndUnderscores) {
  for (const char* address : {"/physics/motor/angularservoposition", "/physics/motor/angular_servo_position",
                              "/Physics/Motor/AngularServoPosition", "/physics/motor/angularservoposition/"}) {
    Rig rig;
    EXPECT_EQ(rig.send(address, "arm", "elbow", 0.5, 0.25, 1.5).kind, Kind::applied) << address;
    EXPECT_EQ(rig.read("/physics/body/arm/motor/elbow/angular_servo_position"), (Values{0.5, 0.25, 1.5})) << address;
  }
}

TEST(LegacyMessages, TheWorldTakesNoNames) {
  Rig rig;
  EXPECT_EQ(rig.send("/physics/sim/gravity", -1.62).kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/sim/gravity"), (Values{0, 0, -1.62}));
  EXPECT_EQ(rig.send("/physics/sim/gravity", 1, -2, 3).kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/sim/gravity"), (Values{1, -2, 3}));
  EXPECT_EQ(rig.send("/physics/sim/gravity", "-3.5").kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/sim/gravity"), (Values{0, 0, -3.5}));
  EXPECT_EQ(rig.send("/physics/sim/timestep", 0.02).kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/sim/timestep"), (Values{0.02}));
  // ofxDabPhysics rejected a float here; any number is accepted and rounded
  EXPECT_EQ(rig.send("/physics/sim/substeps", 6.6).kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/sim/substeps"), (Values{7}));

  const std::vector<double> before = rig.everything();
  for (const Outcome& outcome : {rig.send("/physics/sim/gravity", 1, 2), rig.send("/physics/sim/gravity"),
                                 rig.send("/physics/sim/gravity", "arm", 1), rig.send("/physics/sim/substeps", 1, 2)}) {
    EXPECT_EQ(outcome.kind, Kind::rejected);
    EXPECT_FALSE(outcome.error.empty());
  }
  EXPECT_EQ(rig.everything(), before);
}

TEST(LegacyMessages, ForceActsForOneTick) {
  // F = m·a: without gravity 6 N on 1 kg for a tick of 1/60 s leave 0.1 m/s; motors off, so that nothing resists
  Rig rig;
  rig.send("/physics/sim/gravity", 0);
  ASSERT_EQ(rig.send("/physics/motor/mode", "off").kind, Kind::applied);
  model::ShapeModel shape = ball();
  sim::Body& free = **rig.world.add_body("free");
  ASSERT_TRUE(free.add_part("free", **rig.world.shapes().add("ball 2", shape), 1, {{10, 0, 5}, quat_identity()}).ok());
  EXPECT_EQ(rig.send("/physics/part/force", "free", 0, 6, 0).kind, Kind::applied);
  rig.world.step();
  Values v = rig.read("/physics/body/free/part/free/linear_velocity");
  EXPECT_NEAR(v[1], 0.1, 1e-6);
  rig.world.step();
  EXPECT_NEAR(rig.read("/physics/body/free/part/free/linear_velocity")[1], 0.1, 1e-6) << "it ended with its tick";
  // off the center it turns as well: torque r × F = (0.05,0,0) × (0,6,0) = 0.3 N·m about z; a sphere has 2/5·m·r²
  EXPECT_EQ(rig.send("/physics/part/force", "free", "free", 0, 6, 0, 0.05, 0, 0).kind, Kind::applied);
  rig.world.step();
  EXPECT_NEAR(rig.read("/physics/body/free/part/free/angular_velocity")[2], 0.3 / (0.4 * 0.05 * 0.05) / 60, 1e-3);

  EXPECT_EQ(rig.send("/physics/part/force", 0, 0, 1).kind, Kind::applied) << "static parts are skipped";
  for (const Outcome& outcome :
       {rig.send("/physics/part/force", "arm", "base", 0, 0, 1), rig.send("/physics/part/force", 1, 2),
        rig.send("/physics/part/force", "arm", "tip", "x", 1, 2, 3),
        rig.send("/physics/part/force", "missing", 1, 2, 3),
        rig.send("/physics/part/force", "free", std::nan(""), 0, 0)}) {
    EXPECT_EQ(outcome.kind, Kind::rejected);
  }
}

TEST(LegacyMessages, ChangingJointFramesIsRejectedWithTheReason) {
  for (const char* address : {"/physics/joint/basis", "/physics/joint/prevpos", "/physics/joint/nextpos"}) {
    Rig rig;
    const Outcome outcome = rig.send(address, 1, 0, 0);
    EXPECT_EQ(outcome.kind, Kind::rejected) << address;
    EXPECT_NE(outcome.error.find("can't be changed"), std::string::npos) << outcome.error;
  }
}

// the parameters in the spelling of ofxDabPhysics, with type and number of values
struct LegacyParameter {
  const char* type;
  const char* name;
  std::size_t numbers;
};
constexpr LegacyParameter kParameters[] = {
    {"ForceBehavior", "dir", 3},
    {"ForceBehavior", "amp", 1},
    {"ForceBehavior", "maxAmp", 1},
    {"ForceBehavior", "appInterval", 1},
    {"RandomForceBehavior", "minDir", 3},
    {"RandomForceBehavior", "maxDir", 3},
    {"RandomForceBehavior", "minAmp", 1},
    {"RandomForceBehavior", "maxAmp", 1},
    {"RandomForceBehavior", "randInterval", 1},
    {"RandomForceBehavior", "appInterval", 1},
    {"TorqueBehavior", "torque", 3},
    {"TorqueBehavior", "scale", 1},
    {"RandomTorqueBehavior", "minTorque", 3},
    {"RandomTorqueBehavior", "maxTorque", 3},
    {"RandomTorqueBehavior", "scale", 1},
    {"RotationTargetBehavior", "target", 3},
    {"RotationTargetBehavior", "speed", 1},
    {"RandomRotationTargetBehavior", "minTarget", 3},
    {"RandomRotationTargetBehavior", "maxTarget", 3},
    {"SpeedBehavior", "speed", 1},
    {"SpeedBehavior", "amount", 1},
    {"TargetAttractionBehavior", "targetPos", 3},
    {"TargetAttractionBehavior", "minDist", 1},
    {"TargetAttractionBehavior", "maxDist", 1},
    {"VolumeBehavior", "maxDist", 1},
    {"CohesionBehavior", "minDist", 1},
    {"CohesionBehavior", "maxDist", 1},
    {"CohesionBehavior", "amount", 1},
    {"AlignmentBehavior", "linearAmount", 1},
    {"AlignmentBehavior", "angularAmount", 1},
};

TEST(LegacyMessages, SetsBehaviorParametersInBothForms) {
  for (const LegacyParameter& p : kParameters) {
    Rig rig;
    sim::BehaviorList& list = rig.world.behaviors();
    const bool grouped = list.types().find(p.type)->is_group;
    if (grouped) {
      ASSERT_TRUE(list.add_group(p.type, "it").ok());
    } else {
      ASSERT_TRUE(list.add(*rig.world.find_body("arm"), p.type, "it").ok());
      ASSERT_TRUE(list.add(*rig.world.find_body("1"), p.type, "it").ok());
    }
    const auto value = [&](const char* body) {
      const sim::Behavior& behavior = *rig.world.find_body(body)->behaviors().find("it");
      std::vector<double> out(3);
      rig.store.get(behavior.id(), *behavior.type().table->find(p.name), out.data());
      return out[p.numbers - 1];
    };
    const auto send = [&](std::vector<Arg> names, double last) {
      names.push_back(arg(p.name));
      for (std::size_t i = 1; i <= p.numbers; i++) names.push_back(arg(i == p.numbers ? last : 0.25));
      return rig.dispatcher.execute({"/physics/behavior/parameter", names});
    };
    EXPECT_EQ(send({arg("it")}, 0.5).kind, Kind::applied) << p.type << " " << p.name;
    EXPECT_EQ(value("arm"), 0.5) << p.type << " " << p.name;
    EXPECT_EQ(value("1"), 0.5) << p.type << " " << p.name;
    EXPECT_EQ(send({arg("arm"), arg("it")}, 0.75).kind, Kind::applied) << p.type << " " << p.name;
    EXPECT_EQ(value("arm"), 0.75) << p.type << " " << p.name;
    EXPECT_EQ(value("1"), 0.5) << p.type << " " << p.name;
  }
}

TEST(LegacyMessages, EveryWritablePropertyHasAMessage) {
  // derived: a property added to a table works at once, without more code
  Rig rig;
  std::set<std::string> listed;
  for (const PropertyTable* table :
       {&sim::World::table(), &sim::Part::table(), &sim::Joint::table(), &sim::Motor::table()}) {
    const std::string element = table == &sim::Part::table() ? "tip" : "elbow";
    for (const Property& property : table->properties()) {
      const std::string address = MessageDispatcher::legacy_address(*table, property);
      EXPECT_EQ(address.empty(), property.kind == PropertyKind::readout) << property.name;
      if (address.empty()) continue;
      listed.insert(address);
      EXPECT_NE(rig.send(address).kind, Kind::unknown) << address;
      if (!property.writable()) continue;
      Message m{address, {}};
      if (table != &sim::World::table()) m.args = {arg("arm"), arg(element)};
      for (std::uint32_t i = 0; i < property.width; i++) m.args.push_back(arg(property.initial[i]));
      const Outcome outcome = rig.dispatcher.execute(m);
      EXPECT_EQ(outcome.kind, Kind::applied) << address << ": " << outcome.error;
    }
  }
  for (const Address& a : kElementAddresses) EXPECT_TRUE(listed.contains(legacy_address(a))) << legacy_address(a);
  for (const char* a : {"/physics/sim/gravity", "/physics/sim/timestep", "/physics/sim/substeps"})
    EXPECT_TRUE(listed.contains(a)) << a;
}

}  // namespace
}  // namespace limber::engine::test
