// The definitions for editors: complete, correct, well-formed, and equal to the committed file.
#include "script/annotate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <lua.hpp>
#include <set>

#include "base/text.h"
#include "luacats.h"
#include "properties/property_text.h"
#include "stage.h"
#include "support/policy_files.h"

namespace limber::script {
namespace {

std::string names_of_scenes() {
  ScriptFixture fixture;
  return fixture.scene.names();
}

struct Annotate : testing::Test {
  std::string names = names_of_scenes();
  std::string text = annotations(names);
  luacats::Reader read{text};

  bool has(const std::string& owner, const std::string& member) {
    const auto found = read.classes.find(owner);
    return found != read.classes.end() &&
           (found->second.fields.contains(member) || found->second.functions.contains(member));
  }
};

TEST_F(Annotate, CommittedFileIsUpToDate) {
  std::ifstream in(LIMBER_SOURCE_DIR "/scripts/library/limber.d.lua");
  const std::string committed{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(committed, text) << "update it: build/limber annotate scripts/library/limber.d.lua";
}

TEST_F(Annotate, EveryLineIsWellFormed) {
  for (const std::string& complaint : read.complaints) ADD_FAILURE() << "limber.d.lua:" << complaint;
  EXPECT_GT(read.classes.size(), 20U);
}

TEST_F(Annotate, LuaReadsIt) {
  const std::unique_ptr<lua_State, decltype(&lua_close)> state(luaL_newstate(), &lua_close);
  EXPECT_EQ(luaL_loadbuffer(state.get(), text.data(), text.size(), "@limber.d.lua"), 0)
      << lua_tostring(state.get(), -1);
}

TEST_F(Annotate, DocumentsEveryNameThatScriptsSee) {
  for (const std::string_view line : split(names, '\n')) {
    if (line.empty()) continue;
    const std::string name(line);
    const std::size_t separator = name.find_first_of(".:");
    const std::string owner = name.substr(0, separator);
    const bool is_documented = separator == std::string::npos
                                   ? read.globals.contains(name) || read.functions.contains(name)
                                   : has(owner, name.substr(separator + 1)) || read.functions.contains(name) ||
                                         has(owner + "_maker", name.substr(separator + 1));
    EXPECT_TRUE(is_documented || read.comments.find(" " + name + " ") != std::string::npos)
        << name << ": give it a few lines in src/script/annotations";
  }
}

TEST_F(Annotate, DocumentsOnlyExistingNames) {
  std::set<std::string> real;
  for (const std::string_view line : split(names, '\n')) {
    std::string name(line);
    if (const std::size_t colon = name.find(':'); colon != std::string::npos) name[colon] = '.';
    real.insert(name);
  }
  for (const char* owner : {"sim", "body", "part", "joint", "motor", "shape", "osc"}) {
    for (const auto& [field, about] : read.classes[owner].fields) {
      EXPECT_TRUE(real.contains(std::string(owner) + "." + field)) << owner << "." << field;
    }
    for (const auto& [name, function] : read.classes[owner].functions) {
      EXPECT_TRUE(real.contains(std::string(owner) + "." + name)) << owner << ":" << name;
    }
  }
}

TEST_F(Annotate, ValuesHaveTheDocumentedMembers) {
  // An instance of each class that names() does not list; the suggestions for an unknown member must be documented.
  const std::pair<const char*, const char*> kValues[] = {{"vec3", "vec3()"},
                                                         {"quat", "quat()"},
                                                         {"rng", "rng"},
                                                         {"timer", "sim:after(1, print)"},
                                                         {"address", "osc:to('127.0.0.1:9')"},
                                                         {"link", "body:link('base')"},
                                                         {"policy", "policy"}};
  ScriptFixture fixture;
  fixture.write("urdf/one.urdf", R"(<robot name="one"><link name="base"/></robot>)");
  fixture.write("one.safetensors", limber::test::linear_policy({1, 1}, {1}));
  ASSERT_EQ(fixture.run("body = sim:load_urdf('urdf/one.urdf') policy = sim:load_policy('one.safetensors')"), "");
  for (const auto& [name, expression] : kValues) {
    const luacats::Class& documented = read.classes[name];
    std::vector<std::string> members;
    for (const auto& [field, about] : documented.fields) members.push_back(field);
    for (const auto& [method, function] : documented.functions) members.push_back(method);
    ASSERT_FALSE(members.empty()) << name;
    for (const std::string& member : members) {
      const Evaluation found = fixture.scene.evaluate(std::string("(") + expression + ")." + member);
      EXPECT_EQ(found.kind, Evaluation::Kind::value) << name << "." << member << ": " << found.text;
    }
    const std::string error = first_line(fixture.scene.evaluate(std::string("(") + expression + ").zzzzz").text);
    const std::size_t list = error.find("there are: ");
    ASSERT_NE(list, std::string::npos) << error;
    std::string offered = error.substr(list + 11);
    for (char& c : offered) c = c == ',' ? ' ' : c;
    for (const std::string_view member : split(offered, ' ')) {
      EXPECT_TRUE(member.empty() || has(name, std::string(member))) << name << " has " << member;
    }
  }
}

TEST_F(Annotate, BehaviorsHaveTheDocumentedMembers) {
  const auto documented = [&](const char* name) {
    std::set<std::string> members;
    for (const auto& [field, about] : read.classes[name].fields) members.insert(field);
    for (const auto& [method, function] : read.classes[name].functions) members.insert(method);
    return members;
  };
  // a step that reads each documented member of self
  std::string step = "step = function(self)\n";
  for (const std::string& member : documented("behavior_self")) {
    step += "print('" + member + "', (pcall(function() return self." + member + " end)))\n";
  }
  step += "print(select(2, pcall(function() return self.zzzzz end))) end }";
  ScriptFixture fixture;
  fixture.write("behaviors_lua/bare.lua", "return behavior { " + step);
  fixture.write("behaviors_lua/bare_group.lua", "return behavior { group = true, " + step);
  ASSERT_EQ(fixture.play("body = sim:add_body('b') body:add_part('p', sim:add_sphere_shape('s', 1))\n"
                         "all = sim:add_group_behavior('bare_group', 'all') one = body:add_behavior('bare', 'one')",
                         1),
            "");
  const std::size_t count = documented("behavior_self").size() + 1;
  ASSERT_GT(count, 13u);
  ASSERT_EQ(fixture.host.printed.size(), 2 * count);
  for (std::size_t i = 0; i < 2 * count; i++) {
    const std::string& line = fixture.host.printed[i];
    if (i % count + 1 < count) {
      const bool of_groups = line.starts_with("neighbor");
      EXPECT_TRUE(line.ends_with(i >= count && of_groups ? "\tfalse" : "\ttrue")) << line;
      continue;
    }
    const std::size_t list = line.find("there are: ");
    ASSERT_NE(list, std::string::npos) << line;
    for (const std::string_view member : split(std::string_view(line).substr(list + 11), ' ')) {
      const std::string name(member.substr(0, member.find(',')));
      EXPECT_TRUE(name == "…" || documented("behavior_self").contains(name)) << name;
    }
  }
  // the console's completions must be the members of a handle
  for (const auto& [thing, name] : {std::pair{"one", "behavior"}, std::pair{"all", "behavior_group"}}) {
    std::set<std::string> real;
    for (const char* separator : {".", ":"}) {
      const std::string words = fixture.scene.complete(std::string(thing) + separator).text;
      for (const std::string_view word : split(words, '\n')) real.emplace(word);
    }
    EXPECT_EQ(documented(name), real) << name;
  }
}

TEST_F(Annotate, EveryPropertyHasTypeUnitRangeDefaultAndDescription) {
  const std::pair<const char*, const PropertyTable*> kClasses[] = {
      {"sim", &sim::World::table()},   {"body", &sim::Body::table()},   {"part", &sim::Part::table()},
      {"joint", &sim::Joint::table()}, {"motor", &sim::Motor::table()}, {"shape", &sim::Shape::table()}};
  std::size_t seen = 0;
  for (const auto& [name, table] : kClasses) {
    const luacats::Class& documented = read.classes[name];
    for (const Property& property : table->properties()) {
      seen++;
      if (property.kind == PropertyKind::action) {
        EXPECT_NE(documented.functions.at(property.name).doc.find(property.doc), std::string::npos) << property.name;
        continue;
      }
      const std::string& about = documented.fields.at(property.name);
      const std::size_t words = about.find(" # ");
      ASSERT_NE(words, std::string::npos) << property.name;
      EXPECT_NE(about.find(property.doc, words), std::string::npos) << about;
      EXPECT_NE(about.find(property.unit, words), std::string::npos) << about;
      EXPECT_EQ(about.find("# read-only") != std::string::npos, !property.writable()) << about;
      const bool has_default = about.find("default " + initial_text(property) + ".") != std::string::npos;
      EXPECT_EQ(has_default, property.kind == PropertyKind::setting) << about;
      const bool counts = property.type == PropertyType::number || property.type == PropertyType::vec3 ||
                          property.type == PropertyType::integer;
      const bool ranged = about.find(" .. ") != std::string::npos;
      EXPECT_TRUE(ranged || !property.writable() || !counts || !std::isfinite(property.max)) << about;
      for (const std::string& choice : property.choices) EXPECT_LT(about.find("\"" + choice + "\""), words) << about;
      // every writable property must be an option
      const std::string options = std::string(name) + "_opts";
      EXPECT_TRUE(has(options, property.name) || !property.writable() || !read.classes.contains(options))
          << property.name;
    }
  }
  EXPECT_GT(seen, 70U);
  EXPECT_TRUE(read.classes["motor"].fields["angular_servo_position"].starts_with("vec3like|number # rad, "));
}

TEST_F(Annotate, EveryFunctionHasADescription) {
  for (const auto& [owner, each] : read.classes) {
    for (const auto& [name, function] : each.functions) EXPECT_NE(function.doc, "") << owner << ":" << name;
  }
  for (const auto& [name, function] : read.functions) EXPECT_NE(function.doc, "") << name;
}

TEST(LuaCats, ReaderReportsMalformedLines) {
  const auto complaints = [](const std::string& text) {
    return luacats::Reader("---@meta\n\n" + text).complaints.size();
  };
  EXPECT_EQ(complaints("---@class a\n---@field b number # kg. Good.\nlocal a_ = {}\n"), 0U);
  for (const char* wrong :
       {"---@class a\n---@field b\n", "---@class a\n---@field b numbr\n", "---@class a\n---@field b number kg\n",
        "---@field b number\n", "---@class a\n---@class a\n", "---@class a\n---@field b number|\n",
        "---@class a\n---@field b fun(x\n", "---@class a\n---@field b \"x\n", "---@param x number\nfunction f(y) end\n",
        "---@param x number\n\n", "---@return\nfunction f() end\n", "---@retrun number\n", "function f()\n", "x = 3\n",
        "---@class a\n---@operator pow(number): a\n", "---@class a: b\n", "---@alias x\n"}) {
    EXPECT_GE(complaints(wrong), 1U) << wrong;
  }
}

}  // namespace
}  // namespace limber::script
