// The Lua reference: complete, equal to the committed pages, with examples for everything, and with true error
// messages.
#include "script/reference/lua_reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

#include "base/text.h"
#include "script/reference/annotation_reader.h"
#include "script/reference/type_words.h"
#include "stage.h"

namespace limber::script {

std::span<const EmbeddedFile> annotation_files();

namespace {

std::string names_seen_by_scenes() {
  ScriptFixture fixture;
  return fixture.scene.names();
}

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Reference : testing::Test {
  std::string names = names_seen_by_scenes();
  LuaReference made = lua_reference(names);
  std::vector<AnnotatedPage> pages = annotated_pages(annotation_files());

  std::string all_text() const {
    std::string text;
    for (const ReferencePage& page : made.pages) text += page.text;
    return text;
  }
};

// The text of an example, with its behavior.
std::string example_text(const std::string& name) {
  std::string text;
  for (const EmbeddedFile* file : {find_example(name), find_example_behavior(name)}) {
    if (file != nullptr) text += file->text;
  }
  return text;
}

TEST_F(Reference, CommittedPagesAreUpToDate) {
  const std::filesystem::path folder = LIMBER_SOURCE_DIR "/docs/reference/lua";
  for (const ReferencePage& page : made.pages) {
    EXPECT_EQ(text_of_file(folder / page.file), page.text)
        << page.file << ": update it: build/limber annotate --markdown docs/reference/lua";
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(std::ranges::find(made.pages, name, &ReferencePage::file) != made.pages.end()) << name;
  }
}

TEST_F(Reference, LinksAndExamplesExist) {
  EXPECT_EQ(made.problems, std::vector<std::string>{});
  EXPECT_GE(made.pages.size(), 18u);
}

TEST_F(Reference, LinesHave120Columns) {
  for (const ReferencePage& page : made.pages) {
    for (const std::string_view line : split(page.text, '\n')) {
      const auto columns =
          std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
      EXPECT_LE(columns, 120) << page.file << ": " << line;
    }
  }
}

TEST_F(Reference, HasEveryNameThatScriptsSee) {
  const std::string text = all_text();
  for (const std::string_view name : split(names, '\n')) {
    if (name.empty()) continue;
    static const std::set<std::string_view> libraries = {"bit", "coroutine", "math", "string", "table"};
    const std::string quoted = libraries.contains(name) ? fmt::format("## `{}`", name) : fmt::format("`{}`", name);
    std::string method = quoted;  // osc.send is osc:send
    if (name.starts_with("osc.") || name.starts_with("presets.")) method[method.find('.')] = ':';
    EXPECT_TRUE(text.find(quoted) != std::string::npos || text.find(method) != std::string::npos) << name;
  }
}

TEST_F(Reference, EveryFunctionHasAnExampleThatCallsIt) {
  int functions = 0;
  for (const AnnotatedPage& page : pages) {
    for (const AnnotatedBlock& block : page.blocks) {
      if (block.kind != AnnotatedBlock::Kind::function) continue;
      functions++;
      const std::size_t separator = block.name.find_first_of(".:");
      const std::string call = separator == std::string::npos ? block.name : block.name.substr(separator);
      EXPECT_FALSE(block.examples.empty())
          << block.name << ": add ---@example NAME, and NAME.lua in src/script/examples";
      for (const std::string& example : block.examples) {
        const std::regex pattern((separator == std::string::npos ? "\\b" : "") + call + " ?[({]");
        EXPECT_TRUE(std::regex_search(example_text(example), pattern)) << example << " doesn't call " << block.name;
      }
    }
  }
  EXPECT_GT(functions, 85);
}

TEST_F(Reference, EveryClassHasAnExampleOfItsProperties) {
  for (const AnnotatedPage& page : pages) {
    for (const AnnotatedBlock& block : page.blocks) {
      if (block.kind != AnnotatedBlock::Kind::class_block || block.name.ends_with("_opts")) continue;
      EXPECT_FALSE(block.examples.empty())
          << block.name << ": add ---@example NAME, and NAME.lua in src/script/examples";
      if (block.properties == nullptr) continue;
      for (const std::string& example : block.examples) {
        const std::string text = example_text(example);
        EXPECT_TRUE(std::ranges::any_of(block.properties->properties(),
                                        [&](const Property& property) {
                                          return std::regex_search(text, std::regex("\\b" + property.name + "\\b"));
                                        }))
            << example << " uses no property of " << block.name;
      }
    }
  }
}

TEST_F(Reference, EveryExampleBelongsToAnEntry) {
  std::set<std::string> used;
  for (const AnnotatedPage& page : pages) {
    used.insert(page.notes.examples.begin(), page.notes.examples.end());
    for (const AnnotatedBlock& block : page.blocks) used.insert(block.examples.begin(), block.examples.end());
  }
  for (const EmbeddedFile& file : example_files()) {
    const std::string name = std::filesystem::path(file.name).stem().string();
    EXPECT_TRUE(used.contains(name)) << name;
  }
}

// True if the pieces between "…" occur in this order; the first and the last are the beginning and the end.
bool matches(std::string_view text, const std::string& documented) {
  std::string pattern;
  for (const char c : documented) {
    if (std::string_view("^$\\.*+?()[]{}|").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  for (const std::string_view more : {" …", "…"}) {
    for (std::size_t at = pattern.find(more); at != std::string::npos; at = pattern.find(more))
      pattern.replace(at, more.size(), ".*");
  }
  return std::regex_match(std::string(text), std::regex(pattern));
}

// The message of the error of this code at the top level of a scene, without the place.
std::string error_message_of(const std::string& code) {
  ScriptFixture fixture;
  for (const char* file : {"urdf/arm6.urdf"}) {
    fixture.write(file, text_of_file(std::filesystem::path(LIMBER_SOURCE_DIR) / file));
  }
  std::filesystem::create_directory_symlink(LIMBER_SOURCE_DIR "/urdf/meshes", fixture.folder / "urdf/meshes");
  const std::string error = fixture.run(
      "arm = sim:load_urdf('urdf/arm6.urdf', { name = 'arm' })\n"
      "shape = sim:add_sphere_shape('ball', 0.1)\n"
      "body = sim:add_body('body')\n"
      "body:add_part('ball', shape)\n"
      "body:add_part('cube', sim:add_box_shape('cube', vec3(0.2, 0.2, 0.2)), { position = vec3(1, 0, 0) })\n" +
      (std::regex_search(code, std::regex("^[^({]* = |^[a-z_:.()0-9]+ = ")) ? code : "local _ = " + code));
  std::string line = first_line(error);
  const std::string place = "scripts/scene.lua:6: ";
  const std::size_t at = line.find(place);
  return at == std::string::npos ? "no error in the line: " + line : line.substr(at + place.size());
}

TEST_F(Reference, ErrorsAreAsDocumented) {
  int errors = 0;
  for (const AnnotatedPage& page : pages) {
    for (const AnnotatedBlock& block : page.blocks) {
      for (const AnnotatedError& error : block.errors) {
        errors++;
        const std::string message = error_message_of(error.code);
        EXPECT_TRUE(matches(message, error.message))
            << block.name << ": " << error.code << "\n  documented: " << error.message << "\n  actual:     " << message;
      }
    }
  }
  EXPECT_GT(errors, 60);
}

TEST(ReferenceTypes, AreInWords) {
  const auto words = [](std::string_view type) {
    return type_in_words(type, [](std::string_view name) { return "<" + std::string(name) + ">"; });
  };
  EXPECT_EQ(words("string|integer|part"), "<string>, whole number or <part>");
  EXPECT_EQ(words("\"a|b\"|\"c\""), "`\"a|b\"` or `\"c\"`");
  EXPECT_EQ(words("body?"), "<body> or nil");
  EXPECT_EQ(words("string|(string|part)[]"), "<string> or list of <string> or <part>");
  EXPECT_EQ(words("fun(dt: number)"), "function `function(dt: number)`");
  EXPECT_EQ(words("table<string, number>"), "table `{ [string] = … }`");
}

}  // namespace
}  // namespace limber::script
