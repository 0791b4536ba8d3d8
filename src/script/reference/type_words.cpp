// Reads types recursively.
#include "script/reference/type_words.h"

#include <vector>

#include <fmt/format.h>

namespace limber::script {

namespace {

// the pieces between '|' outside of brackets and quotes
std::vector<std::string_view> alternatives(std::string_view type) {
  std::vector<std::string_view> list;
  std::size_t start = 0;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= type.size(); i++) {
    const char c = i < type.size() ? type[i] : '|';
    if (c == '"') quoted = !quoted;
    if (c == '(' || c == '<') depth++;
    if (c == ')' || c == '>') depth--;
    if (c != '|' || (i < type.size() && (depth > 0 || quoted))) continue;
    list.push_back(type.substr(start, i - start));
    start = i + 1;
  }
  return list;
}

}  // namespace

std::string type_in_words(std::string_view type, const std::function<std::string(std::string_view)>& link) {
  std::vector<std::string> words;
  for (std::string_view piece : alternatives(type)) {
    const bool or_nil = piece.ends_with('?') && !piece.starts_with("fun(");
    if (or_nil) piece.remove_suffix(1);
    if (piece.starts_with("fun(")) {
      words.push_back(fmt::format("function `function{}`", piece.substr(3)));
    } else if (piece.ends_with("[]")) {
      piece.remove_suffix(2);
      if (piece.starts_with('(')) piece = piece.substr(1, piece.size() - 2);
      words.push_back("list of " + type_in_words(piece, link));
    } else if (piece.starts_with('"')) {
      words.push_back(fmt::format("`{}`", piece));
    } else if (piece.starts_with("table<")) {
      words.push_back(fmt::format("table `{{ [{}] = … }}`", piece.substr(6, piece.find(',') - 6)));
    } else if (piece == "integer") {
      words.emplace_back("whole number");
    } else if (piece == "any") {
      words.emplace_back("any value");
    } else {
      words.push_back(link(piece));
    }
    if (or_nil) words.emplace_back("nil");
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); i++) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " or ";
    text += words[i];
  }
  return text;
}

}  // namespace limber::script
