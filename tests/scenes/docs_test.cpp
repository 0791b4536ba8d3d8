// The pages of docs/ and the README: every block of Lua is played, every error shown is the actual one, every example
// of a message is accepted.
#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "app/program.h"
#include "doc_page.h"
#include "player.h"
#include "sim/behavior/behavior_type.h"

namespace limber {
namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// first lines of the texts of these messages
std::vector<std::string> texts_of_messages(Player& player, const std::string& address, std::size_t argument) {
  std::vector<std::string> texts;
  for (const Message& message : player.sent()) {
    if (message.address == address) texts.push_back(first_line(message.args.at(argument).text));
  }
  return texts;
}
std::vector<std::string> faults(Player& player) { return texts_of_messages(player, "/script/error", 2); }
std::vector<std::string> error_messages(Player& player) { return texts_of_messages(player, "/error", 1); }

class LuaPage : public testing::TestWithParam<const char*> {};

TEST_P(LuaPage, EveryBlockBehavesAsDocumented) {
  const ShowFolder show;
  const std::vector<DocBlock> all = blocks_of_page(GetParam());
  int played = 0;
  // behaviors and bodies are written before the scenes that use them, regardless of their order on the page
  for (const DocBlock& block : all) show.write(block.file, block.text);
  for (const DocBlock& block : all) {
    if (!block.file.starts_with("scripts/")) continue;
    SCOPED_TRACE(GetParam() + (":" + std::to_string(block.line)) + " " + block.file);
    Player player(show.write(block.file, block.text), Player::MayFail{});
    const std::string expected_error = block.output.empty() ? "" : first_line(block.output.front());
    played++;
    if (block.expected == "error") {
      ASSERT_FALSE(player.started.ok());
      EXPECT_EQ(first_line(player.started.error()), expected_error);
      continue;
    }
    ASSERT_TRUE(player.started.ok()) << player.started.error();
    for (int i = 0; i < 120; i++) player.engine->tick();
    const std::vector<std::string> wrong = faults(player);
    if (block.expected == "fails") {
      EXPECT_EQ(wrong, std::vector<std::string>{expected_error});
      EXPECT_EQ(player.world().tick(), 120u) << "the show plays on";
    } else {
      EXPECT_EQ(block.expected, "");
      EXPECT_EQ(wrong, std::vector<std::string>{});
      EXPECT_EQ(player.engine->faults(), 0u);
    }
  }
  EXPECT_GT(played, 0);
}

// A behavior on a page is tested only if a scene on the page uses it.
TEST_P(LuaPage, EveryBehaviorOnThePageIsPlayed) {
  std::string scenes;
  for (const DocBlock& block : blocks_of_page(GetParam())) {
    if (block.file.starts_with("scripts/")) scenes += block.text;
  }
  for (const DocBlock& block : blocks_of_page(GetParam())) {
    if (!block.file.starts_with("behaviors_lua/")) continue;
    const std::string type = std::filesystem::path(block.file).stem().string();
    EXPECT_NE(scenes.find("\"" + type + "\""), std::string::npos) << type;
  }
}

INSTANTIATE_TEST_SUITE_P(Docs, LuaPage,
                         testing::Values("docs/learn/scripting.md", "docs/howto/bodies.md",
                                         "docs/reference/behaviors.md", "docs/howto/presets.md", "docs/howto/shapes.md",
                                         "docs/howto/textures.md", "docs/howto/joints.md", "docs/howto/platforms.md",
                                         "docs/howto/controllers.md", "docs/howto/reading.md", "docs/howto/sensors.md",
                                         "docs/howto/camera.md", "docs/howto/time.md", "docs/howto/faq.md",
                                         "docs/howto/loops.md", "docs/howto/tendons.md", "docs/howto/lighting.md",
                                         "docs/howto/experiments.md", "docs/howto/mocap.md", "docs/howto/routes.md",
                                         "docs/howto/qualities.md", "docs/howto/policies.md"),
                         [](const auto& page) { return std::filesystem::path(page.param).stem().string(); });

TEST(Docs, TheTutorialIsComplete) { EXPECT_GE(blocks_of_page("docs/learn/scripting.md").size(), 12u); }

// ---- docs/howto/bodies.md

TEST(Docs, InspectPrintsTheOutputOnThePageOfBodies) {
  const app::test::TempFolder folder;
  const std::vector<DocBlock> blocks = blocks_of_page("docs/howto/bodies.md");
  const auto body = std::find_if(blocks.begin(), blocks.end(), [](const DocBlock& b) { return b.language == "xml"; });
  ASSERT_NE(body, blocks.end());
  ASSERT_EQ(body->output.size(), 2u) << "the output of inspect, and its error for a comma";
  folder.file(body->file, body->text);
  const app::test::RunResult result = app::test::run({"inspect", body->file}, folder.path());
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out + result.err, body->output[0]);
  const std::string mass = "mass value=\"0.5\"";
  std::string mistyped = body->text;
  ASSERT_NE(mistyped.find(mass), std::string::npos);
  mistyped.replace(mistyped.find(mass), mass.size(), "mass value=\"0,5\"");
  folder.file(body->file, mistyped);
  const app::test::RunResult wrong = app::test::run({"inspect", body->file}, folder.path());
  EXPECT_NE((wrong.out + wrong.err).find(body->output[1]), std::string::npos) << wrong.out << wrong.err;
}

TEST(Docs, TheMjcfExampleOnThePageOfBodiesHasNoProblem) {
  const app::test::TempFolder folder;
  const std::vector<DocBlock> blocks = blocks_of_page("docs/howto/bodies.md");
  const auto body =
      std::find_if(blocks.begin(), blocks.end(), [](const DocBlock& b) { return b.file == "hopper.xml"; });
  ASSERT_NE(body, blocks.end());
  folder.file(body->file, body->text);
  const app::test::RunResult result = app::test::run({"inspect", body->file}, folder.path());
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find("torso_x"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find(": warning: "), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find(": error: "), std::string::npos) << result.out;
}

// ---- docs/reference/behaviors.md

bool is_number(const std::string& word) { return std::regex_match(word, std::regex("-?[0-9.]+")); }

// arguments of a message: numbers are floats, the rest is text
Message message_of(const std::string& line) {
  std::istringstream words(line);
  Message message;
  words >> message.address;
  for (std::string word; words >> word;) {
    message.args.push_back(is_number(word) ? Arg::of(std::stof(word)) : Arg::of(word));
  }
  return message;
}

// bodies with the parts and joints of the page's examples
constexpr const char* kExampleBodies = R"(
local shape, place = sim:add_sphere_shape("ball", 0.05), 0
local function chain(name, parts)
  local body = sim:add_body(name)
  for i, part in ipairs(parts) do
    place = place + 0.2
    body:add_part(part, shape, { mass = 0.1, position = vec3(place, 0, 1) })
    if i > 1 then body:add_motor(body:add_joint(part, parts[i - 1], part)) end
  end
  return body
end
local arm = chain("arm", { "base", "elbow", "tip" })
local creature = chain("creature", { "back", "left1", "right1", "left2", "right2" })
local ball, fish = chain("ball", { "ball" }), { chain("fish1", { "fish" }), chain("fish2", { "fish" }) }
)";

TEST(Docs, EveryExampleOfABehaviorWorks) {
  const ShowFolder show;
  const std::vector<std::string> lines = lines_of_page("docs/reference/behaviors.md");
  std::size_t examples = 0;
  for (std::size_t i = 0; i + 1 < lines.size(); i++) {
    const std::string line = lines[i].substr(std::min<std::size_t>(4, lines[i].size()));
    if (!lines[i].starts_with("    ") || line.find(":add_") == std::string::npos) continue;
    SCOPED_TRACE("docs/reference/behaviors.md:" + std::to_string(i + 1) + " " + line);
    examples++;
    Player player(show.write("scripts/example.lua", kExampleBodies + line));
    ASSERT_TRUE(player.started.ok());
    player.play(0.1);
    const Message message = message_of(lines[i + 1]);
    EXPECT_TRUE(message.address.starts_with("/physics/")) << lines[i + 1];
    player.send(message.address, message.args);
    player.play(0.1);
    EXPECT_EQ(error_messages(player), std::vector<std::string>{});
    EXPECT_EQ(player.engine->faults(), 0u);
    // a misspelled address is rejected
    player.send(message.address + "s", message.args);
    player.play(0.1);
    EXPECT_EQ(error_messages(player).size(), 1u);
  }
  EXPECT_EQ(examples, sim::BehaviorTypes().all().size()) << "one for each built-in type";
}

TEST(Docs, TheFirstMessagesToBehaviorsAreAccepted) {
  const ShowFolder show;
  const DocBlock first = blocks_of_page("docs/reference/behaviors.md").at(0);
  Player player(show.write(first.file, first.text));
  const std::regex call("    oscsend localhost 9003 (\\S+) ([a-z]+) (.*)");
  int sent = 0;
  for (const std::string& line : lines_of_page("docs/reference/behaviors.md")) {
    std::smatch match;
    if (!std::regex_match(line, match, call)) continue;
    SCOPED_TRACE(line);
    Message message = message_of(match[1].str() + " " + match[3].str());
    message.args.resize(match[2].str().size());  // the description follows
    player.send(message.address, message.args);
    player.play(0.1);
    EXPECT_EQ(error_messages(player), std::vector<std::string>{});
    sent++;
  }
  EXPECT_EQ(sent, 4);
  EXPECT_EQ(player.value("/physics/body/arm/behavior/wind/max_amp"), 5);
  EXPECT_EQ(player.value("/physics/body/arm/behavior/wind/active"), 0);
  EXPECT_EQ(player.value("/physics/group/swarm/amount"), 3);
}

// ---- docs/howto/console.md, README.md

Evaluation evaluate(Player& player, const std::string& text) {
  Evaluation answer;
  auto request = std::make_shared<engine::EvaluationRequest>();
  request->text = text;
  request->on_result = [&](const Evaluation& evaluation) { answer = evaluation; };
  player.link.command_queue.push({{}, {CommandSource::console}, request});
  player.engine->tick();
  return answer;
}

TEST(Docs, TheConsoleAnswersAsDocumented) {
  const std::vector<DocBlock> blocks = blocks_of_page("docs/howto/console.md");
  ASSERT_EQ(blocks.size(), 1u);
  ASSERT_EQ(blocks[0].language, "console");
  Player player(LIMBER_SOURCE_DIR "/" + blocks[0].file);
  player.play(1);
  const std::string prompt = "limber> ";
  const std::string more = "     .. ";
  std::istringstream lines(blocks[0].text);
  std::string input;
  std::string shown;
  int evaluated = 0;
  const auto check_input = [&] {
    if (input.empty()) return;
    const Evaluation answer = evaluate(player, input);
    EXPECT_EQ(answer.text.empty() ? "" : answer.text + "\n", shown) << input;
    EXPECT_EQ(answer.kind, shown.empty() ? Evaluation::Kind::done : Evaluation::Kind::value) << input;
    evaluated++;
  };
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(prompt)) {
      check_input();
      input = line.substr(prompt.size());
      shown.clear();
    } else if (line.starts_with(more)) {
      input += "\n" + line.substr(more.size());
    } else {
      shown += line + "\n";
    }
  }
  check_input();
  EXPECT_GE(evaluated, 3);
}

TEST(Docs, ConsoleLinesOnOtherPagesAreAccepted) {
  Player player("arms.lua");
  player.play(0.1);
  const std::map<std::string, std::regex> patterns = {
      {"README.md", std::regex("`(sim[.:][^`]*)`")},
      {"docs/howto/console.md", std::regex("-e '([^']*)'|\"evaluate\":\"([^\"]*)\"|printf '([^']*)'")}};
  for (const auto& [page, pattern] : patterns) {
    int found = 0;
    for (const std::string& line : lines_of_page(page)) {
      for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match) {
        std::string text;
        for (std::size_t group = 1; group < match->size(); group++) text += (*match)[group].str();
        text = std::regex_replace(text, std::regex("\\\\n"), "\n");
        std::istringstream each(text);
        for (std::string one; std::getline(each, one);) {
          const Evaluation answer = evaluate(player, one);
          EXPECT_TRUE(answer.kind == Evaluation::Kind::value || answer.kind == Evaluation::Kind::done)
              << page << ": " << one << ": " << answer.text;
          found++;
        }
      }
    }
    EXPECT_GT(found, 0) << page;
  }
}

}  // namespace
}  // namespace limber
