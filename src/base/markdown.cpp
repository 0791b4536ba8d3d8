// Counts characters, not bytes.
#include "base/markdown.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/text.h"
#include "base/utf8.h"

namespace limber {

namespace {

constexpr std::size_t kMaxColumns = 120;

// number of characters; continuation bytes of UTF-8 don't count
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return !continues_utf8(c); }));
}

// True for a word that would begin a list, a heading or a quote at the start of a line.
bool begins_block(std::string_view word) {
  if (word.empty()) return true;
  const std::size_t digits = word.find_first_not_of("0123456789");
  const bool number = digits != 0 && digits != std::string_view::npos && word.substr(digits) == ".";
  return number || word == "-" || word == "+" || word == "*" || word == "=" || word[0] == '#' || word[0] == '>';
}

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

}  // namespace

std::string wrapped(std::string_view text, std::string_view prefix) {
  // words that would begin a list or a heading stay on the line of the word before
  std::vector<std::string> units;
  for (const std::string_view word : split(text, ' ')) {
    if (units.empty() || !begins_block(word)) {
      units.emplace_back(word);
    } else {
      units.back() += fmt::format(" {}", word);
    }
  }
  std::string out(prefix);
  std::size_t width = prefix.size();
  for (std::size_t i = 0; i < units.size(); i++) {
    const std::size_t length = columns(units[i]);
    if (i > 0 && width + 1 + length > kMaxColumns) {
      out += fmt::format("\n{}", std::string(prefix.size(), ' '));
      width = prefix.size();
    } else if (i > 0) {
      out += ' ';
      width++;
    }
    out += units[i];
    width += length;
  }
  return out + "\n";
}

std::string markdown_text(std::string_view text) {
  std::string out;
  bool code = false;
  for (const char c : text) {
    if (c == '`') code = !code;
    if (c == '\n') {
      out += ' ';
    } else if (c == '<' && !code) {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string first_sentence(std::string_view text) {
  for (std::size_t dot = text.find(". "); dot != std::string_view::npos; dot = text.find(". ", dot + 1)) {
    // not in a range such as 0 .. 1
    if (dot > 0 && text[dot - 1] != '.' && text[dot - 1] != ' ') return std::string(text.substr(0, dot + 1));
  }
  return std::string(text);
}

std::string capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string heading_anchor(std::string_view heading) {
  std::string anchor;
  for (const char c : heading) {
    if (c >= 'A' && c <= 'Z') {
      anchor += static_cast<char>(c - 'A' + 'a');
    } else if (is_letter_or_digit(c) || c == '_' || c == '-') {
      anchor += c;
    } else if (c == ' ') {
      anchor += '-';
    }
  }
  return anchor;
}

}  // namespace limber
