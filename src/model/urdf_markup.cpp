// The mark-up scanner: tags, comments, CDATA, declarations; nesting without recursion.
#include "model/urdf_markup.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "model/urdf_text.h"

namespace limber {

namespace {

// parsers compare each attribute of an element with all others
constexpr int kMostAttributes = 65;

/// Walks over the mark-up and blanks what must not reach a parser.
class Scanner {
 public:
  Scanner(std::string& text, Problems& problems) : text_(text), problems_(problems) {}

  /// Whether there was any element.
  bool run() {
    while (at_ < text_.size()) {
      const std::size_t open = text_.find('<', at_);
      if (open == std::string::npos) break;
      at_ = open;
      if (starts("<!--")) {
        skip_past("-->");
      } else if (starts("<![CDATA[")) {
        skip_past("]]>");
      } else if (starts("<?")) {
        skip_past("?>");
        blank(open, at_);
      } else if (starts("<!")) {
        skip_declaration();
        blank(open, at_);
        say_declaration(open);
      } else if (tag(open)) {
        break;
      }
    }
    finish();
    quote_bare_values();
    return any_;
  }

 private:
  bool starts(std::string_view what) const { return std::string_view(text_).substr(at_, what.size()) == what; }
  void skip_past(std::string_view what) {
    const std::size_t found = text_.find(what, at_);
    at_ = found == std::string::npos ? text_.size() : found + what.size();
  }
  void blank(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (text_[i] != '\n') text_[i] = ' ';
    }
  }
  /// To behind the declaration's '>', an internal subset in brackets and quoted text included.
  void skip_declaration() {
    char quote = 0;
    bool subset = false;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (quote != 0) {
        quote = c == quote ? '\0' : quote;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '[' || c == ']') {
        subset = c == '[';
      } else if (c == '>' && !subset) {
        ++at_;
        return;
      }
    }
  }
  void say_declaration(std::size_t open) {
    if (declaration_said_) return;
    declaration_said_ = true;
    problems_.error(line_of(text_, open), "a DOCTYPE is not read: it could pull in other files; left out",
                    "Take the DOCTYPE out and write what its entities stand for.");
  }
  /// One start or end tag at `open`; true when it ends the first element.
  bool tag(std::size_t open) {
    const bool closing = starts("</");
    char quote = 0;
    int attributes = 0;
    std::size_t too_many = std::string::npos;
    std::size_t i = open + 1;
    for (; i < text_.size() && (quote != 0 || text_[i] != '>'); ++i) {
      if (quote != 0) {
        quote = text_[i] == quote ? '\0' : quote;
      } else if (text_[i] == '"' || text_[i] == '\'') {
        quote = text_[i];
      } else if (text_[i] == '=' && !closing) {
        if (++attributes == kMostAttributes) too_many = text_.find_last_of(" \t\r\n", i);
        i = note_bare_value(i);
      }
    }
    const bool empty = !closing && i > open + 1 && text_[i - 1] == '/';
    at_ = std::min(i + 1, text_.size());
    any_ = true;
    if (too_many != std::string::npos) drop_attributes(too_many, empty ? i - 1 : i);
    if (i >= text_.size()) return false;
    depth_ += closing ? -1 : (empty ? 0 : 1);
    if (!closing && depth_ + (empty ? 1 : 0) > kMostUrdfDepth && deep_from_ == std::string::npos) {
      deep_from_ = open;
      deep_depth_ = depth_ - (empty ? 0 : 1);
    }
    if (deep_from_ != std::string::npos && depth_ <= deep_depth_ && (closing || empty)) cut_deep();
    return depth_ <= 0;
  }
  void drop_attributes(std::size_t from, std::size_t to) {
    if (!attributes_said_) {
      problems_.error(line_of(text_, from),
                      fmt::format("an element has more than {} attributes; the rest is left out", kMostAttributes - 1),
                      "URDF needs no more than six: take the others out.");
    }
    attributes_said_ = true;
    blank(from, std::max(from, to));
  }
  /// Remembers an attribute's value without quotes after the '=' at `equals`; gives where to go on.
  std::size_t note_bare_value(std::size_t equals) {
    const std::size_t from = text_.find_first_not_of(" \t\r\n", equals + 1);
    if (from == std::string::npos || std::string_view("\"'<>=/").find(text_[from]) != std::string_view::npos)
      return equals;
    std::size_t to = std::min(text_.find_first_of(" \t\r\n>", from), text_.size());
    if (to < text_.size() && text_[to] == '>' && text_[to - 1] == '/') --to;
    // within the value alone: a look to the end of the text for each value would take quadratic time
    if (std::string_view(text_).substr(from, to - from).find_first_of("\"'<") != std::string_view::npos) return equals;
    bare_.emplace_back(from, to);
    return to - 1;
  }
  void quote_bare_values() {
    std::string quoted;
    std::size_t done = 0;
    int count = 0;
    for (const auto& [from, to] : bare_) {
      // what was blanked or cut since is not there any more
      if (to > text_.size() || text_[from] == ' ') continue;
      if (count++ == 0) {
        problems_.warning(line_of(text_, from), "an attribute's value has no quotes; read as if it had",
                          "Write name=\"value\".");
      }
      quoted.append(text_, done, from - done).append("\"").append(text_, from, to - from).append("\"");
      done = to;
    }
    if (count > 0) text_ = quoted.append(text_, done, std::string::npos);
  }
  void cut_deep() {
    if (!deep_said_) {
      problems_.error(
          line_of(text_, deep_from_),
          fmt::format("elements are nested more than {} deep; the deeper ones are left out", kMostUrdfDepth),
          "A URDF needs no more than six levels: take the nesting out.");
    }
    deep_said_ = true;
    blank(deep_from_, at_);
    deep_from_ = std::string::npos;
  }
  void finish() {
    if (deep_from_ != std::string::npos) {
      at_ = text_.size();
      cut_deep();
    }
    if (depth_ > 0 || !any_) {
      if (any_) {
        problems_.error(line_of(text_, text_.size()), fmt::format("the file ends inside {} open element(s)", depth_),
                        "The file may be cut off: get it again, or close every element.");
      }
      return;
    }
    const std::size_t more = text_.find_first_not_of(" \t\r\n", at_);
    if (more != std::string::npos && text_.compare(more, 4, "<!--") != 0) {
      problems_.warning(line_of(text_, more), "what follows the end of the first element is not read",
                        "One file holds one robot: take the rest out.");
    }
    text_.resize(at_);
  }

  std::string& text_;
  Problems& problems_;
  std::size_t at_ = 0;
  std::size_t deep_from_ = std::string::npos;
  int depth_ = 0;
  int deep_depth_ = 0;
  bool deep_said_ = false;
  bool declaration_said_ = false;
  bool attributes_said_ = false;
  bool any_ = false;
  std::vector<std::pair<std::size_t, std::size_t>> bare_;  // values without quotes, from and to
};

}  // namespace

int line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

bool clean_markup(std::string& text, Problems& problems) { return Scanner(text, problems).run(); }

}  // namespace limber
