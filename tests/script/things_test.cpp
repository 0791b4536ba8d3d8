// Objects: all properties of all classes through Lua, handles, lists, error texts.
#include <gtest/gtest.h>

#include <cmath>

#include <fmt/format.h>

#include "stage.h"

namespace limber::script {
namespace {

constexpr const char* kArm = R"(
local arm = sim:add_body("arm")
local box = sim:add_box_shape("box", { 0.2, 0.2, 0.5 })
local base = arm:add_part("base", box, { mass = 0 })
local link = arm:add_part("link", box, { mass = 2, position = { 0, 0, 0.6 } })
local tip = arm:add_part("tip", box, { position = vec3(0, 0, 1.2) })
local j1 = arm:add_joint("joint_1", base, link, { position = { 0, 0, 0.3 }, axis = { 1, 0, 0 } })
local j2 = arm:add_joint("joint_2", "link", "tip", { type = "prismatic" })
local m1 = arm:add_motor(j1)
local m2 = arm:add_motor("joint_2", { max_linear_force = 50 })
)";

const std::string kLine = "scripts/scene.lua:12: ";  // the line of the text after kArm

std::string arm_error(const std::string& text) { return error_of(std::string(kArm) + "\n" + text); }
std::string arm_value(const std::string& expression) { return value_of(expression, kArm); }

// one of two values of the property's type within its range, in Lua syntax
std::string sample(const Property& property, int which) {
  const double low = std::max(property.min, -50.0);
  const double high = std::min(property.max, 50.0);
  const auto number = [&](double part) {
    const double v = low + (high - low) * part;
    return fmt::format("{}", property.type == PropertyType::integer ? std::round(v) : v);
  };
  const double shift = which == 0 ? 0.1 : 0.3;
  switch (property.type) {
    case PropertyType::vec3:
      return fmt::format("vec3({}, {}, {})", number(shift), number(shift + 0.1), number(shift + 0.2));
    case PropertyType::flags3:
      return which == 0 ? "{ true, false, true }" : "{ false, true, true }";
    case PropertyType::quat:
      return which == 0 ? "quat(0.6, 0, 0, 0.8)" : "quat(0, 0.8, 0, 0.6)";
    case PropertyType::boolean:
      return which == 0 ? "false" : "true";
    case PropertyType::choice:
      return fmt::format("'{}'", property.choices[static_cast<std::size_t>(which) % property.choices.size()]);
    default:
      return number(shift);
  }
}

std::string shown(const Property& property, const double* v) {
  switch (property.type) {
    case PropertyType::vec3:
      return fmt::format("{:.10g} {:.10g} {:.10g}", v[0], v[1], v[2]);
    case PropertyType::flags3:
      return fmt::format("{} {} {}", v[0] != 0, v[1] != 0, v[2] != 0);
    case PropertyType::quat:
      return fmt::format("{:.10g} {:.10g} {:.10g} {:.10g}", v[0], v[1], v[2], v[3]);
    case PropertyType::boolean:
      return v[0] != 0 ? "true" : "false";
    case PropertyType::choice:
      return property.choices[static_cast<std::size_t>(v[0])];
    default:
      return fmt::format("{:.10g}", v[0]);
  }
}

constexpr const char* kShow = R"(
local function show(v)
  if type(v) == "number" then return string.format("%.10g", v) end
  if type(v) ~= "cdata" then return tostring(v) end
  if tostring(v):find("^quat") then return string.format("%.10g %.10g %.10g %.10g", v.x, v.y, v.z, v.w) end
  if tostring(v):find("^vec3") then return string.format("%.10g %.10g %.10g", v.x, v.y, v.z) end
  return tostring(v[1]) .. " " .. tostring(v[2]) .. " " .. tostring(v[3])
end
)";

struct Class {
  const PropertyTable& table;
  const char* expression;
};

std::vector<Class> classes() {
  return {{sim::World::table(), "sim"}, {sim::Body::table(), "arm"}, {sim::Part::table(), "link"},
          {sim::Joint::table(), "j1"},  {sim::Joint::table(), "j2"}, {sim::Motor::table(), "m1"},
          {sim::Motor::table(), "m2"}};
}

NodeId node_of(const ScriptFixture& fixture, const std::string& expression) {
  const sim::Body& arm = *fixture.world.find_body("arm");
  if (expression == "sim") return fixture.world.id();
  if (expression == "arm") return arm.id();
  if (expression == "link") return arm.find_part("link")->id();
  if (expression == "j1") return arm.find_joint("joint_1")->id();
  if (expression == "j2") return arm.find_joint("joint_2")->id();
  return expression == "m1" ? arm.find_motor("joint_1")->id() : arm.find_motor("joint_2")->id();
}

TEST(Things, ABodyCanBePlacedBeforeItHasParts) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.run(R"(
local ball = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("a", { position = vec3(1, 2, 3) })
print(body.position)
body:add_part("first", ball)
body:add_part("second", ball)
print(body.position, body:part("first").position, body:part("second").position)
local own = sim:add_body("b", { position = vec3(1, 2, 3), rotation = quat(0, 0, 1, 0) })
own:add_part("first", ball, { position = vec3(4, 5, 6) })
print(own.position, own.rotation.z)
)"),
            "");
  EXPECT_EQ(
      fixture.host.printed,
      (std::vector<std::string>{"vec3(1, 2, 3)", "vec3(1, 2, 3)\tvec3(1, 2, 3)\tvec3(0, 0, 0)", "vec3(4, 5, 6)\t1"}));
}

TEST(Things, EveryWritablePropertyRoundTrips) {
  int checked = 0;
  for (const Class& c : classes()) {
    for (const Property& property : c.table.properties()) {
      if (!property.writable()) continue;
      for (int which = 0; which < 2; which++) {
        ScriptFixture fixture;
        ASSERT_EQ(fixture.run(fmt::format("{}{}{}.{} = {}\nprint(show({}.{}))", kArm, kShow, c.expression,
                                          property.name, sample(property, which), c.expression, property.name)),
                  "")
            << property.name;
        double value[4] = {};
        fixture.store.get(node_of(fixture, c.expression), property, value);
        ASSERT_FALSE(fixture.host.printed.empty());
        EXPECT_EQ(fixture.host.printed.back(), shown(property, value)) << c.expression << "." << property.name;
        // It has the requested value, except the body's angular velocity, which reads the root, which is static here.
        if (property.type == PropertyType::number || property.type == PropertyType::integer) {
          EXPECT_NEAR(value[0], std::stod(sample(property, which)), 1e-9) << property.name;
        }
        checked++;
      }
    }
  }
  EXPECT_GT(checked, 150);
}

TEST(Things, EveryReadoutIsReadOnly) {
  for (const Class& c : classes()) {
    for (const Property& property : c.table.properties()) {
      if (property.kind != PropertyKind::readout) continue;
      ScriptFixture fixture;
      ASSERT_EQ(fixture.run(fmt::format("{}{}print(show({}.{}))", kArm, kShow, c.expression, property.name)), "")
          << property.name;
      double value[4] = {};
      fixture.store.get(node_of(fixture, c.expression), property, value);
      EXPECT_EQ(fixture.host.printed.back(), shown(property, value)) << property.name;
      const std::string fault = error_of(fmt::format("{}{}.{} = 1", kArm, c.expression, property.name));
      EXPECT_NE(fault.find(fmt::format("'{}' is a readout: it can be read, not set", property.name)), std::string::npos)
          << fault;
    }
  }
}

TEST(Things, EveryNumberRejectsNonFiniteValuesAndIsClamped) {
  for (const Class& c : classes()) {
    for (const Property& property : c.table.properties()) {
      const bool number = property.type == PropertyType::number || property.type == PropertyType::integer ||
                          property.type == PropertyType::vec3;
      if (!property.writable() || !number) continue;
      const auto wide = [&](const std::string& v) {
        return property.type == PropertyType::vec3 ? fmt::format("vec3({}, {}, {})", v, v, v) : v;
      };
      for (const char* bad : {"0 / 0", "1 / 0", "-1 / 0"}) {
        const std::string fault = error_of(fmt::format("{}{}.{} = {}", kArm, c.expression, property.name, wide(bad)));
        EXPECT_NE(fault.find(fmt::format("'{}' takes finite numbers, not ", property.name)), std::string::npos)
            << fault;
      }
      ScriptFixture fixture;
      const double above = property.max + std::max(1.0, std::abs(property.max) * 0.01);
      ASSERT_EQ(fixture.run(fmt::format("{}for i = 1, 3 do {}.{} = {} end", kArm, c.expression, property.name,
                                        wide(fmt::format("{:.17g}", above)))),
                "");
      double value[4] = {};
      fixture.store.get(node_of(fixture, c.expression), property, value);
      const bool part_of_a_whole =
          property.name.find("velocity") != std::string::npos && &c.table == &sim::Body::table();
      if (!part_of_a_whole) {
        EXPECT_EQ(value[0], property.max) << property.name;
      }
      // reported once for the line, not three times
      int reports = 0;
      for (const std::string& text : fixture.logged()) {
        reports += text.find(fmt::format("'{}' takes ", property.name)) != std::string::npos &&
                   text.find("outside and was clamped") != std::string::npos;
      }
      EXPECT_EQ(reports, 1) << property.name;
    }
  }
}

TEST(Things, ClampingIsReportedOncePerLine) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(std::string(kArm) + R"(
sim:on_step(function()
  link.friction = -1
  link.friction = 1000
end)
)",
                         50),
            "");
  EXPECT_EQ(fixture.logged(),
            (std::vector<std::string>{
                "scripts/scene.lua:13: part 'arm/link': 'friction' takes 0 .. 100; -1 is outside and "
                "was clamped",
                "scripts/scene.lua:14: part 'arm/link': 'friction' takes 0 .. 100; 1000 is outside and "
                "was clamped",
            }));
  EXPECT_TRUE(fixture.host.faults.empty());
}

TEST(Things, OneNumberSetsTheOwnAxis) {
  EXPECT_EQ(value_of("m1.angular_spring_stiffness", std::string(kArm) + "m1.angular_spring_stiffness = 20"),
            "vec3(0, 0, 20)");
  EXPECT_EQ(value_of("m2.linear_servo_position", std::string(kArm) + "m2.linear_servo_position = { 1, 2, 3 } "
                                                                     "m2.linear_servo_position = 0.5"),
            "vec3(1, 2, 0.5)");
  EXPECT_EQ(arm_value("m2.max_linear_force"), "vec3(10000, 10000, 50)");
  EXPECT_EQ(value_of("j1.angular_lower_limit.z", std::string(kArm) + "j1.angular_lower_limit = -1"), "-1");
  EXPECT_EQ(arm_error("m1.linear_servo_position = 1"),
            kLine +
                "motor 'arm/joint_1': one number for 'linear_servo_position' means the own axis, which this joint "
                "does not have among these three; give a vec3");
  EXPECT_EQ(value_of("m1.angular_active", std::string(kArm) + "m1.angular_active = false"), "{ false, false, false }");
  EXPECT_EQ(value_of("m1.angular_active[2]", std::string(kArm) + "m1.angular_active = { false, true, false }"), "true");
  EXPECT_EQ(arm_value("#m1.angular_active, m1.angular_active"), "3\t{ false, false, true }");
}

TEST(Things, HaveMembersThatAreNotProperties) {
  EXPECT_EQ(arm_value("arm.name, link.name, j1.name, m1.name, box.name"), "arm\tlink\tjoint_1\tjoint_1\tbox");
  EXPECT_EQ(arm_value("link.body, link.shape, j1.body, m1.body"), "body 'arm'\tshape 'box'\tbody 'arm'\tbody 'arm'");
  EXPECT_EQ(arm_value("j1.parent, j1.child, j1.motor, m1.joint"),
            "part 'arm/base'\tpart 'arm/link'\tmotor 'arm/joint_1'\tjoint 'arm/joint_1'");
  EXPECT_EQ(arm_value("j1.type, j2.type, arm.root"), "revolute\tprismatic\tpart 'arm/base'");
  EXPECT_EQ(arm_value("m1.mode, m1.target, m2.mode"), "servo\t0\tservo");
  EXPECT_EQ(arm_value("arm:link('tip').position, arm:link('tip').name, arm:link('tip').body"),
            "vec3(0, 0, 1.2)\ttip\tbody 'arm'");
  EXPECT_EQ(arm_value("sim.alive, arm.alive, arm:link('tip').alive"), "true\ttrue\ttrue");
  EXPECT_EQ(arm_value("sim:add_body('empty'):bounds()"), "nil") << "it has no shape";
  EXPECT_EQ(arm_value("#arm:state_hash(), #sim:state_hash(), arm:state_hash() ~= sim:state_hash()"), "16\t16\ttrue");
}

// derived values are computed in Lua and in C++: bit-identical, at any time
TEST(Things, CentersAndInertiasMatchTheWorldExactly) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
local both = sim:add_compound_shape("both")
both:add_child(sim:add_box_shape("box", { 0.2, 0.3, 0.5 })):add_child(sim:add_sphere_shape("sphere", 0.3), { 0.1, 0.7, 3 })
local part = sim:add_body("a"):add_part("p", both, { mass = 1.7, position = { 0.1, 0.2, 0.3 } })
local shown = ("%.17g "):rep(6)
local function show()
  local c, i = part.center, part.inertia
  print(shown:format(c.x, c.y, c.z, i.x, i.y, i.z))
end
sim:on_start(show)
sim:on_start(function()
  part.position, part.rotation, part.mass = vec3(-3.3, 0.7, 1 / 3), quat.euler(0.3, -1.1, 2.2), 0.3
  show()
  part.body:copy("b", { position = vec3(5, 0, 0) })
end)
sim:on_start(function()
  part.position, part.rotation, part.mass = vec3(9, 9, 9), quat(), 9
  error("no")
end)
sim:on_start(show)
)"),
            "");
  const auto values_of_world = [&] {
    const sim::Part& part = *fixture.world.find_body("a")->root();
    double inertia[3];
    fixture.store.get(part.id(), sim::Part::table().at("inertia"), inertia);
    const Vec3 c = part.center();
    return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} ", c.x, c.y, c.z, inertia[0], inertia[1],
                       inertia[2]);
  };
  ASSERT_EQ(fixture.host.printed.size(), 3u);
  EXPECT_NE(fixture.host.printed[0], fixture.host.printed[1]);
  EXPECT_EQ(fixture.host.printed[1], values_of_world());
  EXPECT_EQ(fixture.host.printed[2], values_of_world());
}

TEST(Things, ObjectsCanBeComparedAndUsedAsKeys) {
  EXPECT_EQ(arm_value("link == arm:part('link'), link == tip, link == nil, j1 == m1, arm == link.body"),
            "true\tfalse\tfalse\tfalse\ttrue");
  EXPECT_EQ(arm_value("({ [link] = 'found' })[arm.parts[2]]"), "found");
}

TEST(Things, HaveErrorTexts) {
  const std::pair<const char*, const char*> cases[] = {
      {"local x = m1.angular_sevro_position",
       "motor 'arm/joint_1' has no property 'angular_sevro_position'; did you mean 'angular_servo_position'?"},
      {"m1.sped = 1", "motor 'arm/joint_1' has no property 'sped'; did you mean 'speed'?"},
      {"link.friction = '1'", "part 'arm/link': 'friction' takes a number, not '1'"},
      {"link.position = 1", "part 'arm/link': 'position' takes a vec3, not 1"},
      {"link.position = nil", "part 'arm/link': 'position' takes a vec3, not nothing"},
      {"link.rotation = vec3()", "part 'arm/link': 'rotation' takes a quat, not vec3(0, 0, 0)"},
      {"link.report_contacts = 1", "part 'arm/link': 'report_contacts' takes true or false, not 1"},
      {"m1.mode = 'sevo'", "motor 'arm/joint_1': 'mode' can't be 'sevo'; did you mean 'servo'?"},
      {"m1.mode = 2", "motor 'arm/joint_1': 'mode' takes one of 'off' 'spin' 'servo' 'spring' 'torque', not 2"},
      {"m1.angular_active = 1",
       "motor 'arm/joint_1': 'angular_active' takes three booleans, or one for all axes, not 1"},
      {"m1.angular_active[3] = true", "three booleans are immutable; assign all of them: { false, false, true }"},
      {"link.position.z = 2", "this member is read-only; of a vec3 or quat assign the whole value"},
      {"link.name = 'x'", "part 'arm/link': 'name' can be read, not set"},
      {"link.apply_force = 1", "part 'arm/link': 'apply_force' is a method: call it with a colon, it can't be set"},
      {"link.apply_force(vec3())",
       "apply_force is a method of a part: write it with a colon, part:apply_force(…), not with a dot"},
      {"arm.part('tip')", "part is a method of a body: write it with a colon, body:part(…), not with a dot"},
      {"link:position()", "this is a vec3, not a function: use a dot for members, a colon only for methods"},
      {"link:mass()",
       "attempt to call method 'mass' (a number value); use a dot for members, a colon only for methods"},
      {"for m in arm.motors() do end", "to iterate over motors use a colon: for x in object:motors(…) do"},
      {"arm:part('tipp')", "body 'arm' has no part 'tipp'; did you mean 'tip'?"},
      {"arm:motor('joint_3')", "body 'arm' has no motor 'joint_3'; did you mean 'joint_1'?"},
      {"arm:part(4)", "body 'arm' has 3 parts; there is no 4"},
      {"arm:part(true)", "expected the name or number of a part, not true"},
      {"sim:body('ar')", "there is no body 'ar'; did you mean 'arm'?"},
      {"arm:link('hand')", "body 'arm' has no link 'hand'; there are: base, link, tip"},
      {"sim:add_body('arm')", "there is a body 'arm' already; names are unique"},
      {"arm:add_part('tip', box)", "there is a part 'tip' already; names are unique"},
      {"arm:add_part('new', 'bo')", "there is no shape 'bo'; did you mean 'box'?"},
      {"arm:add_part('new', box, { mas = 1 })", "add_part: opts has no 'mas'; did you mean 'mass'?"},
      {"arm:add_part('new', box, { mass = -1 })", "add_part: mass must not be negative (0: a part that never moves)"},
      {"arm:add_joint('j', base, tip, { type = 'rvolute' })",
       "joint 'arm/j': there is no joint type 'rvolute'; did you mean 'revolute'?"},
      {"arm:add_joint('j', base, base)", "joint 'arm/j': parent and child must be different parts"},
      {"arm:add_motor(j1)", "joint 'arm/joint_1' has a motor already"},
      {"base.mass = 3",
       "/physics/body/arm/part/base/mass: the part was created static (mass 0); create it with a mass instead"},
      {"sim:add_sphere_shape('s', -1)", "shape 's': a sphere needs a radius of 0.0001 .. 10000 m, not -1"},
      {"sim:add_box_shape('s', 3)", "add_box_shape: the size (full edges) takes a vec3, not 3"},
      {"sim.bodies.arm = 1", "the list of bodies is read-only"},
      {"local x = arm.parts.tip",
       "a list of parts has no member 'tip'; a part is found by body:part(name) or by a number in [ ]"},
      {"local x = sim.gravty", "sim has no property 'gravty'; did you mean 'gravity'?"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(arm_error(text), kLine + expected) << text;
}

TEST(Things, ActionsRequireCallbacks) {
  EXPECT_EQ(
      arm_error("link:apply_force(vec3(1, 0, 0))"),
      kLine +
          "part 'arm/link':apply_force acts on the running scene; at the top level use sim:on_start(function() … end)");
  for (const char* action : {"arm:reset()", "arm:remove()", "sim:reset()", "osc:send('/a')", "osc:reply('/a')",
                             "sim:after(1, print):cancel()", "link:apply_impulse({ 0, 0, 1 })"}) {
    EXPECT_NE(arm_error(action).find("acts on the running scene; at the top level use sim:on_start"), std::string::npos)
        << action;
    if (std::string(action).find("reply") == std::string::npos) {
      EXPECT_EQ(callback_error_of(kArm, action), "no error") << action;
    }
  }
  EXPECT_EQ(callback_error_of(kArm, "link:apply_force(1)"),
            "scripts/scene.lua:11: part 'arm/link': 'apply_force' takes 3 or 6 numbers (a vec3 is three), not 1");
  EXPECT_EQ(callback_error_of(kArm, "link:apply_force(vec3(0 / 0))").substr(0, 80),
            "scripts/scene.lua:11: part 'arm/link': 'apply_force' takes finite numbers, not n");
  EXPECT_EQ(callback_error_of(kArm, "link:apply_force('up')"),
            "scripts/scene.lua:11: part 'arm/link': 'apply_force' takes vec3s, not 'up'");
}

TEST(Things, ARemovedObjectIsNamedInErrors) {
  EXPECT_EQ(callback_error_of(kArm, "arm:remove() print(link.mass)"),
            "scripts/scene.lua:11: part 'arm/link' no longer exists (check its .alive)");
  EXPECT_EQ(callback_error_of(kArm, "arm:remove() m1.speed = 1"),
            "scripts/scene.lua:11: motor 'arm/joint_1' no longer exists (check its .alive)");
  EXPECT_EQ(callback_error_of(kArm, "arm:remove() arm:part(1)"),
            "scripts/scene.lua:11: body 'arm' no longer exists (check its .alive)");
  ScriptFixture fixture;
  // slots are reused: old handles stay invalid, equal only to themselves
  ASSERT_EQ(fixture.play(std::string(kArm) + R"(
local copy = arm:copy("twin", { position = vec3(3, 0, 0) })
sim:on_start(function()
  arm:remove()
  local again = copy:copy("arm")
  print(arm.alive, link.alive, again.alive, again == arm, arm == arm, again:part("link") == link, #sim.bodies)
  print(link, again:part("link"))
end)
)"),
            "");
  EXPECT_TRUE(fixture.host.faults.empty()) << fixture.host.faults[0].text;
  EXPECT_EQ(fixture.host.printed, (std::vector<std::string>{"false\tfalse\ttrue\tfalse\ttrue\tfalse\t2",
                                                            "part 'arm/link'\tpart 'arm/link'"}));
}

TEST(Things, HaveLists) {
  EXPECT_EQ(arm_value("#arm.parts, arm.parts[1], arm.parts[3], arm.parts[4]"),
            "3\tpart 'arm/base'\tpart 'arm/tip'\tnil");
  EXPECT_EQ(arm_value("arm:part(2), arm:part(-1), arm:joint(-2), arm:part(tip)"),
            "part 'arm/link'\tpart 'arm/tip'\tjoint 'arm/joint_1'\tpart 'arm/tip'");
  EXPECT_EQ(arm_value("sim:find_body('missing'), sim:find_body('arm'), sim:body(1)"), "nil\tbody 'arm'\tbody 'arm'");
  const auto iterate = [](const std::string& loop) {
    return value_of("table.concat(seen, ' ')", std::string(kArm) + "local seen = {} for x, i in " + loop +
                                                   " do seen[#seen + 1] = x.name .. i end");
  };
  EXPECT_EQ(iterate("arm:parts()"), "base1 link2 tip3");
  EXPECT_EQ(iterate("arm:parts('all')"), "base1 link2 tip3");
  EXPECT_EQ(iterate("arm:parts('*i*')"), "link1 tip2");
  EXPECT_EQ(iterate("arm:parts('{tip,base}')"), "base1 tip2");
  EXPECT_EQ(iterate("arm:parts({ 'tip', base })"), "base1 tip2");
  EXPECT_EQ(iterate("arm:parts('x*')"), "");
  EXPECT_EQ(iterate("arm:joints(j2)"), "joint_21");
  EXPECT_EQ(iterate("sim:bodies('a*')"), "arm1");
  EXPECT_EQ(value_of("table.concat(seen, ' ')", std::string(kArm) +
                                                    "local seen = {} for i, m in ipairs(arm.motors) do seen[i] = "
                                                    "i .. m.name end"),
            "1joint_1 2joint_2");
  EXPECT_EQ(arm_error("for x in arm:parts('tipp') do end"),
            kLine + "body 'arm' has no part 'tipp'; did you mean 'tip'?");
}

TEST(Things, AnIterationSkipsRemovedObjects) {
  ScriptFixture fixture;
  ASSERT_EQ(fixture.play(R"(
for i = 1, 5 do sim:add_body("b" .. i) end
sim:on_start(function()
  local seen = {}
  for body in sim:bodies() do
    seen[#seen + 1] = body.name
    if body.name == "b2" then sim:body("b3"):remove() sim:add_body("b6") end
  end
  print(table.concat(seen, " "), #sim.bodies)
end)
)"),
            "");
  EXPECT_EQ(fixture.host.printed, std::vector<std::string>{"b1 b2 b4 b5\t5"});
}

}  // namespace
}  // namespace limber::script
