// The examples of the Lua reference: each plays without errors and warnings, and prints the results in its comments.
#include <string>
#include <vector>

#include "player.h"
#include "script/reference/lua_reference.h"

namespace limber {
namespace {

// The texts after "-->" in the file.
std::vector<std::string> expected_lines(std::string_view example) {
  std::vector<std::string> expected;
  constexpr std::string_view kMark = "--> ";
  for (const std::string_view line : split(example, '\n')) {
    const std::size_t at = line.find(kMark);
    if (at != std::string_view::npos) expected.emplace_back(line.substr(at + kMark.size()));
  }
  return expected;
}

// The messages of its lines "-- limber send ADDRESS NUMBER".
std::vector<Message> messages_to(std::string_view example) {
  std::vector<Message> messages;
  for (const std::string_view line : split(example, '\n')) {
    constexpr std::string_view kSend = "-- limber send ";
    if (!line.starts_with(kSend)) continue;
    const std::vector<std::string_view> words = split(line.substr(kSend.size()), ' ');
    Message& message = messages.emplace_back();
    message.address = words[0];
    for (std::size_t i = 1; i < words.size(); i++)
      message.args.push_back(Arg::of(static_cast<float>(parse_number(words[i]).value())));
  }
  return messages;
}

// What it printed, warned and reported since line `seen` of the log; tabs between printed values are blanks.
std::vector<std::string> printed_since(std::uint64_t seen) {
  std::vector<std::string> lines;
  for (const LogLine& line : log_since(seen)) {
    if (line.level == LogLevel::info) continue;
    std::string text = line.level == LogLevel::print ? "" : line.level == LogLevel::warning ? "warning: " : "error: ";
    for (const char c : line.text) text += c == '\t' ? ' ' : c;
    lines.push_back(text);
  }
  return lines;
}

// Shortens the line where the expected one ends with "…".
std::string cut_like(const std::string& line, const std::string& expected) {
  constexpr std::string_view kMore = "…";
  if (!expected.ends_with(kMore)) return line;
  return line.substr(0, expected.size() - kMore.size()) + std::string(kMore);
}

class ReferenceExample : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceExample, PlaysAndPrintsItsResults) {
  const ShowFolder show;
  for (const EmbeddedFile& file : script::example_files()) {
    if (file.name.starts_with("behaviors_lua/")) show.write(std::string(file.name), std::string(file.text));
  }
  const std::string_view text = script::find_example(GetParam())->text;
  const std::uint64_t seen = log_newest();
  Player player(show.write("scripts/" + GetParam() + ".lua", std::string(text)), Player::MayFail{});
  ASSERT_TRUE(player.started.ok()) << player.started.error();
  player.play(0.5);
  for (const Message& message : messages_to(text)) player.send(message.address, message.args);
  player.play(2.4);
  const std::vector<std::string> expected = expected_lines(text);
  std::vector<std::string> printed = printed_since(seen);
  for (std::size_t i = 0; i < std::min(printed.size(), expected.size()); i++)
    printed[i] = cut_like(printed[i], expected[i]);
  EXPECT_EQ(printed, expected);
  EXPECT_EQ(player.engine->faults(), 0u);
}

std::vector<std::string> example_names() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : script::example_files()) {
    const std::string name = std::filesystem::path(file.name).stem().string();
    if (script::find_example(name) == &file) names.push_back(name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Reference, ReferenceExample, testing::ValuesIn(example_names()),
                         [](const auto& example) { return example.param; });

}  // namespace
}  // namespace limber
