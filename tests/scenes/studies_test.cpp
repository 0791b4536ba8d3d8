// The studies in docs/learn: each step plays, the result is the finished file in scripts/studies, and messages, console
// lines and commands on the pages work.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/program.h"
#include "doc_page.h"
#include "player.h"
#include "support/skip.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using app::test::content;
using app::test::RunResult;

struct Study {
  std::string page;
  std::string scene;                                       ///< The reader's file.
  std::vector<std::pair<std::string, std::string>> files;  ///< The reader's files and the finished ones.
};

const std::vector<Study> kStudies = {
    {"study_ring", "scripts/my_ring.lua", {{"scripts/my_ring.lua", "ring.lua"}}},
    {"study_creature", "scripts/my_creature.lua", {{"scripts/my_creature.lua", "creature.lua"}}},
    {"study_tentacle", "scripts/my_tentacle.lua", {{"scripts/my_tentacle.lua", "../tentacle.lua"}}},
    {"study_dancer", "scripts/my_dancer.lua", {{"scripts/my_dancer.lua", "../dancer.lua"}}},
    {"study_strandbeest", "scripts/my_strandbeest.lua", {{"scripts/my_strandbeest.lua", "../strandbeest.lua"}}},
    {"study_delta", "scripts/my_delta.lua", {{"scripts/my_delta.lua", "../delta.lua"}}},
    {"study_gripper", "scripts/my_gripper.lua", {{"scripts/my_gripper.lua", "../gripper.lua"}}},
    {"study_flock", "scripts/my_flock.lua", {{"scripts/my_flock.lua", "flock.lua"}}},
    {"study_live_coding",
     "scripts/my_live.lua",
     {{"scripts/my_live.lua", "live.lua"}, {"behaviors_lua/ripple.lua", "behaviors_lua/ripple.lua"}}},
    {"study_show", "my_show/scripts/main.lua", {{"my_show/scripts/main.lua", "show/scripts/main.lua"}}},
    {"study_batch", "scripts/my_batch.lua", {{"scripts/my_batch.lua", "batch.lua"}}}};

const Study& study_of(std::string_view page) {
  return *std::find_if(kStudies.begin(), kStudies.end(), [&](const Study& study) { return page == study.page; });
}

std::string page_of(const Study& study) { return "docs/learn/" + study.page + ".md"; }

std::string finished_file(const std::string& name) { return LIMBER_SOURCE_DIR "/scripts/studies/" + name; }

std::string without_newlines_at_end(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

/// A file that grows block by block: a block is appended after an empty line, or replaces the block with the same first
/// line.
class GrowingFile {
 public:
  void apply(const std::string& block) {
    const std::string text = without_newlines_at_end(block);
    const std::string first = text.substr(0, text.find('\n'));
    for (auto& [line, section] : sections_) {
      if (line != first) continue;
      section = text;
      return;
    }
    sections_.emplace_back(first, text);
  }
  std::string text() const {
    std::string all;
    for (const auto& [line, section] : sections_) all += (all.empty() ? "" : "\n") + section + "\n";
    return all;
  }

 private:
  std::vector<std::pair<std::string, std::string>> sections_;
};

/// The reader's folder, in which the blocks of a page are applied one after the other.
class ReaderFolder {
 public:
  ReaderFolder() {
    // `limber new show` writes this file
    folder_.file("my_show/urdf/reed.urdf", content(LIMBER_SOURCE_DIR "/src/app/templates/show/urdf/reed.urdf"));
    fs::create_directories(path("build"));
    fs::create_symlink(LIMBER_PROGRAM, path("build/limber"));
  }
  std::string path(const std::string& name = "") const { return folder_.path() + "/" + name; }
  std::string text(const std::string& file) { return files_[file].text(); }

  void apply(const DocBlock& block) {
    files_[block.file].apply(block.text);
    folder_.file(block.file, text(block.file));
  }
  /// Writes the file with one more block, which apply() drops.
  void try_out(const DocBlock& block) {
    GrowingFile file = files_[block.file];
    file.apply(block.text);
    folder_.file(block.file, file.text());
  }
  void apply_all(const Study& study) {
    for (const DocBlock& block : blocks_of_page(page_of(study))) {
      if (block.language == "lua" && block.expected.empty()) apply(block);
    }
  }

 private:
  app::test::TempFolder folder_;
  std::map<std::string, GrowingFile> files_;
};

std::vector<std::string> error_texts(Player& player) {
  std::vector<std::string> texts;
  for (const Message& message : player.sent()) {
    if (message.address == "/error") texts.push_back(message.args.at(1).text);
    if (message.address == "/script/error") texts.push_back(message.args.at(2).text);
  }
  return texts;
}

class Studies : public testing::TestWithParam<Study> {};

TEST_P(Studies, EveryStepPlays) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  ReaderFolder reader;
  const std::string scene = reader.path(GetParam().scene);
  int steps = 0;
  for (const DocBlock& block : blocks_of_page(page_of(GetParam()))) {
    if (block.language != "lua") continue;
    SCOPED_TRACE(page_of(GetParam()) + ":" + std::to_string(block.line));
    steps++;
    if (block.expected == "error") {
      reader.try_out(block);
      Player player(scene, Player::MayFail{});
      ASSERT_FALSE(player.started.ok());
      ASSERT_EQ(block.output.size(), 1u);
      const std::string text = player.started.error();
      EXPECT_EQ(text.substr(0, text.find('\n')) + "\n", block.output[0]);
      continue;
    }
    ASSERT_EQ(block.expected, "");
    reader.apply(block);
    if (!fs::exists(scene)) continue;
    Player player(scene, Player::MayFail{});
    ASSERT_TRUE(player.started.ok()) << player.started.error();
    player.play(1);
    EXPECT_EQ(error_texts(player), std::vector<std::string>{});
    EXPECT_EQ(player.engine->faults(), 0u);
  }
  EXPECT_GE(steps, 7);
}

TEST_P(Studies, TheResultIsTheFinishedFile) {
  ReaderFolder reader;
  reader.apply_all(GetParam());
  for (const auto& [file, finished] : GetParam().files) {
    EXPECT_EQ(reader.text(file), content(finished_file(finished))) << finished;
  }
}

TEST_P(Studies, TheFinishedSceneStaysFinite) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  const RunResult result =
      app::test::run({finished_file(GetParam().files[0].second), "--fast", "--strict", "--duration", "12", "--quiet"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

// "    oscsend 127.0.0.1 9003 /scene/waves f 5": a message of that page; quotes are those of the shell
std::vector<Message> oscsend_lines(const std::string& page) {
  std::vector<Message> messages;
  for (const std::string& line : lines_of_page(page)) {
    if (!line.starts_with("    oscsend 127.0.0.1 9003 ")) continue;
    std::istringstream words(std::regex_replace(line.substr(27), std::regex("'"), ""));
    Message message;
    std::string tags;
    words >> message.address >> tags;
    std::string word;
    for (const char tag : tags) {
      EXPECT_TRUE(words >> word) << line;
      message.args.push_back(tag == 's' ? Arg::of(word) : Arg::of(std::stod(word)));
    }
    EXPECT_FALSE(words >> word) << line;
    messages.push_back(message);
  }
  return messages;
}

TEST_P(Studies, EveryMessageIsAccepted) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "other tests of scenes execute the same code");
  ReaderFolder reader;
  reader.apply_all(GetParam());
  Player player(reader.path(GetParam().scene));
  player.play(0.5);
  player.sent();
  const std::vector<Message> messages = oscsend_lines(page_of(GetParam()));
  for (const Message& message : messages) {
    player.send(message.address, message.args);
    player.play(0.1);
    EXPECT_EQ(error_texts(player), std::vector<std::string>{}) << message.address;
  }
  player.play(0.5);
  EXPECT_EQ(player.engine->faults(), 0u);
  EXPECT_EQ(messages.empty(), GetParam().page == "study_batch") << "a batch gets no messages";
}

INSTANTIATE_TEST_SUITE_P(Docs, Studies, testing::ValuesIn(kStudies),
                         [](const auto& study) { return study.param.page.substr(6); });

TEST(StudyOfShow, ThePresetsAreThoseOfThePage) {
  ReaderFolder reader;
  const Study& study = study_of("study_show");
  reader.apply_all(study);
  Player player(reader.path(study.scene));
  player.play(0.1);
  for (const Message& message : oscsend_lines(page_of(study))) {
    if (message.address.starts_with("/cue")) break;
    player.send(message.address, message.args);
    player.play(0.1);
  }
  const double eye = player.value("/visuals/camera/eye", 2);
  Player finished("studies/show/scripts/main.lua");
  finished.send("/preset/recall", {Arg::of(std::string("night"))});
  finished.play(0.1);
  EXPECT_EQ(error_texts(finished), std::vector<std::string>{});
  EXPECT_NEAR(finished.value("/visuals/camera/eye", 2), eye, 1e-4);
  for (const char* const path : {"/scene/speed", "/scene/depth", "/scene/length", "/scene/lean",
                                 "/visuals/shape/reed.tip/ambient_scale", "/visuals/shape/reed.stem/diffuse_color"}) {
    EXPECT_NEAR(finished.value(path), player.value(path), 1e-6) << path;
  }
  EXPECT_EQ(content(finished_file("show/urdf/reed.urdf")),
            content(LIMBER_SOURCE_DIR "/src/app/templates/show/urdf/reed.urdf"));
}

// Evaluates the inputs of a console block. An expected value follows its input.
void check_console(Player& player, const DocBlock& block) {
  std::vector<std::pair<std::string, std::string>> inputs;
  std::istringstream lines(block.text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("limber> ")) {
      inputs.emplace_back(line.substr(8), "");
    } else if (line.starts_with("     .. ")) {
      inputs.back().first += "\n" + line.substr(8);
    } else {
      inputs.back().second += line;
    }
  }
  for (const auto& [input, value] : inputs) {
    Evaluation answer;
    auto request = std::make_shared<engine::EvaluationRequest>();
    request->text = input;
    request->on_result = [&answer](const Evaluation& evaluation) { answer = evaluation; };
    player.link.command_queue.push({{}, {CommandSource::console}, request});
    player.engine->tick();
    EXPECT_EQ(answer.text, value) << input;
    EXPECT_EQ(answer.kind, value.empty() ? Evaluation::Kind::done : Evaluation::Kind::value) << input;
  }
  EXPECT_GE(inputs.size(), 3u);
}

TEST(StudyOfLiveCoding, TheConsoleAnswersAsDocumented) {
  ReaderFolder reader;
  reader.apply_all(study_of("study_live_coding"));
  Player player(reader.path(study_of("study_live_coding").scene));
  player.play(0.5);
  int blocks = 0;
  for (const DocBlock& block : blocks_of_page(page_of(study_of("study_live_coding")))) {
    if (block.language != "console") continue;
    check_console(player, block);
    blocks++;
  }
  EXPECT_EQ(blocks, 1);
}

TEST(FirstMinutes, ConsoleAndMessagesWork) {
  const std::string page = "docs/learn/first_minutes.md";
  Player player("hello.lua");
  player.play(0.1);
  for (const DocBlock& block : blocks_of_page(page)) check_console(player, block);
  const std::vector<Message> messages = oscsend_lines(page);
  EXPECT_EQ(messages.size(), 3u);
  for (const Message& message : messages) {
    player.send(message.address, message.args);
    player.play(0.1);
    EXPECT_EQ(error_texts(player), std::vector<std::string>{}) << message.address;
  }
  EXPECT_EQ(player.engine->faults(), 0u);
}

// Runs the commands of the page in the reader's folder. A film needs ffmpeg, and the loop plays one seed instead of
// ten.
TEST(StudyOfBatch, TheCommandsWork) {
  LIMBER_SKIP_IF(kAddressSanitizer || kThreadSanitizer, "the program's tests run the same commands");
  ReaderFolder reader;
  reader.apply_all(study_of("study_batch"));
  std::string commands;
  bool in_block = false;
  for (const std::string& line : lines_of_page(page_of(study_of("study_batch")))) {
    if (line.starts_with("```")) in_block = !in_block;
    const bool command = !in_block && line.starts_with("    ") && !line.starts_with("    ./run");
    if (command && line.find("--render") == std::string::npos) commands += line.substr(4) + "\n";
  }
  commands = std::regex_replace(commands, std::regex("1 2 3 4 5 6 7 8 9 10"), "1");
  commands = std::regex_replace(commands, std::regex("in -0.1 0 0.1"), "in -0.1");
  app::test::Process shell({"sh", "-e", "-c", commands}, reader.path());
  const RunResult result = shell.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  const std::regex line("1,-0.1(,[0-9]+){14}");
  std::istringstream table(content(reader.path("results.csv")));
  int lines = 0;
  for (std::string row; std::getline(table, row); lines++) EXPECT_TRUE(std::regex_match(row, line)) << row;
  EXPECT_EQ(lines, 1);
  EXPECT_TRUE(content(reader.path("seed7.csv")).starts_with("time,ball1/part/ball/x,"));
  const std::regex hash("hash ([0-9a-f]{16}) tick 960\n");
  const auto hashes = std::distance(std::sregex_iterator(result.out.begin(), result.out.end(), hash), {});
  EXPECT_EQ(hashes, 2) << result.out;
}

}  // namespace
}  // namespace limber
