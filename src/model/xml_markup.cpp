// Markup scanner: tags, comments, CDATA and declarations; tracks nesting without recursion.
#include "base/plural.h"
#include "model/xml_text.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace limber::model {

namespace {

// parsers compare each attribute of an element with all others, in quadratic time
constexpr int kMaxAttributes = 65;

/// Scans the markup once and sanitizes it in place.
class Scanner {
 public:
  Scanner(std::string& text, const XmlFormat& format, Problems& problems)
      : text_(text), format_(format), problems_(problems) {}

  /// True if there is at least one element.
  bool run() {
    while (position_ < text_.size()) {
      const std::size_t open = text_.find('<', position_);
      if (open == std::string::npos) break;
      position_ = open;
      if (starts_with("<!--")) {
        skip_past("-->");
      } else if (starts_with("<![CDATA[")) {
        skip_past("]]>");
      } else if (starts_with("<?")) {
        skip_past("?>");
        blank(open, position_);
      } else if (starts_with("<!")) {
        skip_declaration();
        blank(open, position_);
        report_declaration(open);
      } else if (scan_tag(open)) {
        break;
      }
    }
    finish();
    quote_values();
    return has_element_;
  }

 private:
  bool starts_with(std::string_view prefix) const {
    return std::string_view(text_).substr(position_, prefix.size()) == prefix;
  }
  void skip_past(std::string_view terminator) {
    const std::size_t found = text_.find(terminator, position_);
    position_ = found == std::string::npos ? text_.size() : found + terminator.size();
  }
  void blank(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (text_[i] != '\n') text_[i] = ' ';
    }
  }
  /// Skips past the declaration's '>', including an internal subset in brackets and quoted text.
  void skip_declaration() {
    char quote = 0;
    bool subset = false;
    for (; position_ < text_.size(); ++position_) {
      const char c = text_[position_];
      if (quote != 0) {
        quote = c == quote ? '\0' : quote;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '[' || c == ']') {
        subset = c == '[';
      } else if (c == '>' && !subset) {
        ++position_;
        return;
      }
    }
  }
  void report_declaration(std::size_t open) {
    if (declaration_reported_) return;
    declaration_reported_ = true;
    problems_.error(line_of(text_, open), "DOCTYPE ignored: it could include other files",
                    "Remove the DOCTYPE and expand its entities.");
  }
  enum class TagKind { start, end, empty };
  struct Tag {
    TagKind kind = TagKind::start;
    std::size_t end = 0;                            // of its '>'; the size of the text if there is none
    std::size_t too_many_from = std::string::npos;  // end of the last attribute that is allowed
  };

  /// Scans a start or end tag at `open`; true if it ends the first element.
  bool scan_tag(std::size_t open) {
    const Tag tag = read_tag(open);
    position_ = std::min(tag.end + 1, text_.size());
    has_element_ = true;
    if (tag.too_many_from != std::string::npos)
      blank_attributes(tag.too_many_from, tag.kind == TagKind::empty ? tag.end - 1 : tag.end);
    if (tag.end >= text_.size()) return false;
    track_depth(tag.kind, open);
    return depth_ <= 0;
  }
  Tag read_tag(std::size_t open) {
    Tag tag;
    if (starts_with("</")) tag.kind = TagKind::end;
    char quote = 0;
    int attributes = 0;
    std::size_t i = open + 1;
    for (; i < text_.size() && (quote != 0 || text_[i] != '>'); ++i) {
      if (quote != 0) {
        quote = text_[i] == quote ? '\0' : quote;
      } else if (text_[i] == '"' || text_[i] == '\'') {
        quote = text_[i];
      } else if (text_[i] == '=' && tag.kind != TagKind::end) {
        if (++attributes == kMaxAttributes) tag.too_many_from = text_.find_last_of(" \t\r\n", i);
        i = record_unquoted_value(i);
      }
    }
    tag.end = i;
    if (tag.kind == TagKind::start && i > open + 1 && text_[i - 1] == '/') tag.kind = TagKind::empty;
    return tag;
  }
  /// Updates the depth after a tag at `open`; blanks an element that is nested too deep as soon as it ends.
  void track_depth(TagKind kind, std::size_t open) {
    if (kind == TagKind::end) {
      --depth_;
    } else if (depth_ + 1 > format_.max_depth && deep_from_ == std::string::npos) {
      deep_from_ = open;
      deep_depth_ = depth_;
    }
    if (kind == TagKind::start) ++depth_;
    if (deep_from_ != std::string::npos && depth_ <= deep_depth_ && kind != TagKind::start) blank_deep_element();
  }
  void blank_attributes(std::size_t from, std::size_t to) {
    if (!attributes_reported_) {
      problems_.error(line_of(text_, from),
                      fmt::format("an element has more than {} attributes; the rest is ignored", kMaxAttributes - 1),
                      format_.attributes_fix);
    }
    attributes_reported_ = true;
    blank(from, std::max(from, to));
  }
  /// Records an unquoted attribute value after the '=' at `equals`; returns the position to continue after.
  std::size_t record_unquoted_value(std::size_t equals) {
    const std::size_t from = text_.find_first_not_of(" \t\r\n", equals + 1);
    if (from == std::string::npos || std::string_view("\"'<>=/").find(text_[from]) != std::string_view::npos)
      return equals;
    std::size_t to = std::min(text_.find_first_of(" \t\r\n>", from), text_.size());
    if (to < text_.size() && text_[to] == '>' && text_[to - 1] == '/') --to;
    // searches the value only: searching the rest of the text for each value would take quadratic time
    if (std::string_view(text_).substr(from, to - from).find_first_of("\"'<") != std::string_view::npos) return equals;
    unquoted_values_.emplace_back(from, to);
    return to - 1;
  }
  void quote_values() {
    std::string quoted;
    std::size_t copied_to = 0;
    int count = 0;
    for (const auto& [from, to] : unquoted_values_) {
      // the value may have been blanked or cut off since
      if (to > text_.size() || text_[from] == ' ') continue;
      if (count++ == 0) {
        problems_.warning(line_of(text_, from), "an attribute's value has no quotes; quotes added",
                          "Write name=\"value\".");
      }
      quoted.append(text_, copied_to, from - copied_to).append("\"").append(text_, from, to - from).append("\"");
      copied_to = to;
    }
    if (count > 0) text_ = quoted.append(text_, copied_to, std::string::npos);
  }
  void blank_deep_element() {
    if (!depth_reported_) {
      problems_.error(line_of(text_, deep_from_),
                      fmt::format("elements are nested more than {} deep; deeper ones are ignored", format_.max_depth),
                      format_.nesting_fix);
    }
    depth_reported_ = true;
    blank(deep_from_, position_);
    deep_from_ = std::string::npos;
  }
  void finish() {
    if (deep_from_ != std::string::npos) {
      position_ = text_.size();
      blank_deep_element();
    }
    if (depth_ > 0 || !has_element_) {
      if (has_element_) {
        problems_.error(line_of(text_, text_.size()), "the file ends inside " + counted(depth_, "open element"),
                        "The file may be truncated: get it again, or close every element.");
      }
      return;
    }
    const std::size_t more = text_.find_first_not_of(" \t\r\n", position_);
    if (more != std::string::npos && text_.compare(more, 4, "<!--") != 0) {
      problems_.warning(line_of(text_, more), "text after the end of the first element ignored",
                        "A file contains one robot: remove the rest.");
    }
    text_.resize(position_);
  }

  std::string& text_;
  const XmlFormat& format_;
  Problems& problems_;
  std::size_t position_ = 0;
  std::size_t deep_from_ = std::string::npos;
  int depth_ = 0;
  int deep_depth_ = 0;
  bool depth_reported_ = false;
  bool declaration_reported_ = false;
  bool attributes_reported_ = false;
  bool has_element_ = false;
  std::vector<std::pair<std::size_t, std::size_t>> unquoted_values_;  // [from, to)
};

}  // namespace

int line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

bool clean_markup(std::string& text, const XmlFormat& format, Problems& problems) {
  return Scanner(text, format, problems).run();
}

}  // namespace limber::model
