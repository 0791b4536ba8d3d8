// A reader of LuaCATS annotations that is stricter than those of editors: collects the documentation and reports
// malformed lines. For the test of the definitions.
#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace limber::script::luacats {

struct Function {
  std::vector<std::string> params;  ///< As annotated.
  std::string doc;
};
struct Class {
  std::map<std::string, std::string> fields;  ///< Name to the text after it.
  std::map<std::string, Function> functions;
  std::string variable;  ///< The variable after the class's lines, for example `body_`.
};

/// Parses one type and collects the names in it.
class TypeReader {
 public:
  explicit TypeReader(std::string_view text) : text_(text) {}

  bool read() {
    do {
      if (!read_one()) return false;
    } while (take('|'));
    return true;
  }
  std::string_view rest() const { return text_; }
  const std::vector<std::string>& named() const { return named_; }

 private:
  bool take(char c) {
    if (text_.empty() || text_[0] != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take(std::string_view word) {
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  std::string name() {
    std::size_t n = 0;
    while (n < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[n])) != 0 || text_[n] == '_')) n++;
    std::string found(text_.substr(0, n));
    text_.remove_prefix(n);
    return found;
  }
  bool read_one() {
    if (take("fun(")) return read_fun();
    if (take('(')) {
      if (!read() || !take(')')) return false;
    } else if (take('"')) {
      const std::size_t end = text_.find('"');
      if (end == std::string_view::npos) return false;
      text_.remove_prefix(end + 1);
    } else {
      const std::string found = name();
      if (found.empty()) return false;
      named_.push_back(found);
      if (take('<') && !(read_list() && take('>'))) return false;
    }
    while (take("[]")) {
    }
    take('?');
    return true;
  }
  bool read_list() {
    do {
      if (!read()) return false;
    } while (take(", "));
    return true;
  }
  bool read_fun() {
    while (!take(')')) {
      if (!take("...") && name().empty()) return false;
      take('?');
      if (take(": ") && !read()) return false;
      if (!take(", ") && !text_.starts_with(')')) return false;
    }
    return !take(": ") || read_list();
  }

  std::string_view text_;
  std::vector<std::string> named_;
};

class Reader {
 public:
  explicit Reader(const std::string& text) {
    std::istringstream in(text);
    int number = 0;
    for (std::string line; std::getline(in, line);) read(line, ++number);
    for (const auto& [name, where] : named_) {
      if (!known_.contains(name)) complain(where, "no type is called " + name);
    }
  }

  std::vector<std::string> complaints;
  std::map<std::string, Class> classes;
  std::set<std::string> globals;
  std::map<std::string, Function> functions;  ///< Outside of classes: vec3, math.clamp.
  std::string comments;                       ///< Plain comments, with a blank around each word.

 private:
  void complain(int line, const std::string& why) { complaints.push_back(std::to_string(line) + ": " + why); }

  // a type, then nothing or " # " and words
  bool type_and_words(std::string_view text, int line, bool needs_fun = false) {
    if (needs_fun && !text.starts_with("fun(")) return false;
    TypeReader type(text);
    if (!type.read()) return false;
    for (const std::string& name : type.named()) named_.emplace_back(name, line);
    return type.rest().empty() || (type.rest().starts_with(" # ") && type.rest().size() > 3);
  }

  static bool is_word(std::string_view text) {
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
           std::all_of(text.begin(), text.end(),
                       [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; });
  }

  void read(const std::string& line, int number) {
    if (line.starts_with("---@")) {
      annotation(std::string_view(line).substr(4), number);
    } else if (line.starts_with("---")) {
      doc_ += line.substr(3) + "\n";
    } else if (line.starts_with("--")) {
      comments += " " + line.substr(2) + " ";
    } else if (line.starts_with("function ")) {
      function(line, number);
    } else if (!line.empty()) {
      variable(line, number);
    } else {
      finish_block(number);
    }
  }

  void finish_block(int number) {
    if (!params_.empty() || returns_) complain(number, "annotations of a function without one");
    params_.clear();
    returns_ = false;
    doc_.clear();
    class_.clear();
  }

  void annotation(std::string_view text, int number) {
    const std::size_t blank = text.find(' ');
    const std::string_view word = text.substr(0, blank);
    const std::string_view rest = blank == std::string_view::npos ? "" : text.substr(blank + 1);
    bool good = false;
    if (word == "meta") good = rest.empty() && number == 1;
    if (word == "class") good = open_class(rest, number);
    if (word == "field") good = field(rest, number);
    if (word == "param") good = param(rest, number);
    if (word == "return") good = returns_ = type_and_words(rest, number);
    if (word == "type") good = type_and_words(rest, number);
    if (word == "overload") good = type_and_words(rest, number, true);
    if (word == "operator") good = operation(rest, number);
    if (word == "alias") {
      const std::size_t end = rest.find(' ');
      good =
          end != std::string_view::npos && is_word(rest.substr(0, end)) && type_and_words(rest.substr(end + 1), number);
      known_.emplace(rest.substr(0, end));
    }
    if (!good) complain(number, "not well-formed: ---@" + std::string(text));
  }

  bool open_class(std::string_view rest, int number) {
    const std::size_t colon = rest.find(": ");
    class_ = rest.substr(0, colon);
    known_.insert(class_);
    if (colon != std::string_view::npos) named_.emplace_back(rest.substr(colon + 2), number);
    return is_word(class_) && classes.try_emplace(class_).second;
  }

  bool field(std::string_view rest, int number) {
    if (class_.empty()) return false;
    if (rest.starts_with('[')) {
      const std::size_t close = rest.find("] ");
      return close != std::string_view::npos && type_and_words(rest.substr(close + 2), number);
    }
    const std::size_t end = rest.find(' ');
    if (end == std::string_view::npos) return false;
    std::string name(rest.substr(0, end));
    if (name.ends_with('?')) name.pop_back();
    const bool fresh = classes[class_].fields.emplace(name, rest.substr(end + 1)).second;
    return fresh && is_word(name) && type_and_words(rest.substr(end + 1), number);
  }

  bool param(std::string_view rest, int number) {
    const std::size_t end = rest.find(' ');
    if (end == std::string_view::npos) return false;
    std::string name(rest.substr(0, end));
    if (name.ends_with('?')) name.pop_back();
    params_.push_back(name);
    return (name == "..." || is_word(name)) && type_and_words(rest.substr(end + 1), number);
  }

  bool operation(std::string_view rest, int number) {
    static const std::set<std::string_view> kKnown = {"add", "sub", "mul", "div", "unm"};
    const std::size_t end = rest.find_first_of("(:");
    if (class_.empty() || end == std::string_view::npos || !kKnown.contains(rest.substr(0, end))) return false;
    // as a function's type: add(x): y
    return type_and_words(
        rest[end] == '(' ? "fun(x: " + std::string(rest.substr(end + 1)) : "fun()" + std::string(rest.substr(end)),
        number, true);
  }

  // function body_:part(key) end
  void function(const std::string& line, int number) {
    const std::size_t open = line.find('(');
    const std::size_t close = line.find(") end");
    if (open == std::string::npos || close != line.size() - 5) return complain(number, "no stub: " + line);
    const std::string name = line.substr(9, open - 9);
    std::string listed;
    for (const std::string& each : params_) listed += (listed.empty() ? "" : ", ") + each;
    if (listed != line.substr(open + 1, close - open - 1)) complain(number, "takes others than annotated: " + line);
    const std::size_t dot = name.find_first_of(".:");
    const std::string owner = name.substr(0, dot);
    const auto holder =
        std::find_if(classes.begin(), classes.end(), [&](const auto& each) { return each.second.variable == owner; });
    const Function made{params_, doc_};
    if (dot != std::string::npos && holder != classes.end()) {
      holder->second.functions[name.substr(dot + 1)] = made;
    } else {
      functions[name] = made;
    }
    params_.clear();
    returns_ = false;
    doc_.clear();
  }

  // "sim = {}", "local body_ = {}"
  void variable(const std::string& line, int number) {
    const bool is_local = line.starts_with("local ");
    const std::string name = line.substr(is_local ? 6 : 0, line.find(" = ") - (is_local ? 6 : 0));
    if (!line.ends_with(" = {}") || !is_word(name)) return complain(number, "neither a stub nor a table: " + line);
    if (!is_local) globals.insert(name);
    if (!class_.empty()) classes[class_].variable = name;
  }

  std::set<std::string> known_ = {"number", "integer", "boolean", "string", "any", "nil", "table", "false"};
  std::vector<std::pair<std::string, int>> named_;
  std::string class_;
  std::string doc_;
  std::vector<std::string> params_;
  bool returns_ = false;
};

}  // namespace limber::script::luacats
