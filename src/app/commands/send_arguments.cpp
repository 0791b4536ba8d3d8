// With tags, parses tag by tag and consumes the words in order.
#include "app/commands/send_arguments.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr std::string_view kWithoutWord = "TFNI[]";
constexpr std::string_view kWithWord = "ihfdsScrmtb";

bool is_hexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
}

template <std::size_t Digits>
bool is_hexadecimal_of(const std::string& word) {
  return word.size() == Digits && is_hexadecimal(word);
}

struct WordFormat {
  std::string_view tags;
  bool (*fits)(const std::string& word);
  const char* expected;  // for an error message
};
constexpr WordFormat kFormats[] = {
    {"ihfd", [](const std::string& word) { return parse_number(word).has_value(); }, "a number"},
    {"c", [](const std::string& word) { return word.size() == 1 && static_cast<unsigned char>(word[0]) < 128; },
     "one ASCII character"},
    {"r", &is_hexadecimal_of<8>, "8 hexadecimal digits: red, green, blue, alpha"},
    {"m", &is_hexadecimal_of<8>, "8 hexadecimal digits: port, status, data, data"},
    {"t", &is_hexadecimal_of<16>, "16 hexadecimal digits: seconds since 1900, fraction"},
    {"b", [](const std::string& word) { return word.size() % 2 == 0 && is_hexadecimal(word); },
     "pairs of hexadecimal digits"},
};

// describes the expected word for an error message; null: the word is valid
const char* expected_word(char tag, const std::string& word) {
  for (const WordFormat& format : kFormats) {
    if (format.tags.find(tag) != std::string_view::npos) return format.fits(word) ? nullptr : format.expected;
  }
  return nullptr;
}

Arg arg_of_tag(char tag, const std::string& word) {
  if (std::string_view("ihfd").find(tag) != std::string_view::npos) return Arg::of(*parse_number(word));
  return Arg::of(word);
}

// null: valid
const char* fault_of_tags(std::string_view tags) {
  int level = 0;
  for (const char tag : tags) {
    level += tag == '[' ? 1 : tag == ']' ? -1 : 0;
    if (level < 0) return "a ']' without its '['";
  }
  return level == 0 ? nullptr : "a '[' without its ']'";
}

}  // namespace

Arg parse_arg(const std::string& word) {
  const bool quoted = word.size() >= 2 && (word.front() == '\'' || word.front() == '"') && word.back() == word.front();
  if (quoted) return Arg::of(std::string_view(word).substr(1, word.size() - 2));
  if (word == "true" || word == "false") return Arg::of(word == "true");
  const std::optional<double> number = parse_number(word);
  return number ? Arg::of(*number) : Arg::of(word);
}

Result<Message> tagged_message(const std::string& address, std::string_view tags,
                               const std::vector<std::string>& words) {
  if (const char* const error = fault_of_tags(tags)) return Error{fmt::format("--tags '{}' has {}", tags, error)};
  const auto count = static_cast<std::size_t>(
      std::ranges::count_if(tags, [](char tag) { return kWithoutWord.find(tag) == std::string_view::npos; }));
  Message message{address, {}};
  std::size_t at = 0;
  for (const char tag : tags) {
    if (tag == '[' || tag == ']') continue;
    if (kWithoutWord.find(tag) != std::string_view::npos) {
      message.args.push_back(Arg::of(tag == 'T'));
      continue;
    }
    if (kWithWord.find(tag) == std::string_view::npos)
      return Error{fmt::format("--tags: '{}' is not an OSC type tag; the tags are {}{}", tag, kWithWord, kWithoutWord)};
    if (at == words.size()) break;
    const std::string& word = words[at++];
    if (const char* const need = expected_word(tag, word))
      return Error{fmt::format("'{}' must be {}, since its tag is {}", printable(word), need, tag)};
    message.args.push_back(arg_of_tag(tag, word));
  }
  if (at != words.size() || count != words.size())
    return Error{fmt::format("--tags '{}' needs {}, got {}", tags, counted(count, "argument"), words.size())};
  return message;
}

}  // namespace limber::app
