// Cleans a URDF's bytes: encoding, NUL, declarations, depth, and what follows the root element.
#include "model/urdf_text.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

int line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Length of the UTF-8 sequence that starts at `at`, or 0 when it is none (overlong, surrogate, cut off).
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0u) != 0x80u) return 0;
  }
  const unsigned second = byte(at + 1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool surrogate = first == 0xED && second >= 0xA0;
  const bool beyond = first == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

std::string to_utf8(std::string_view bytes, Problems& problems) {
  std::string out;
  out.reserve(bytes.size());
  std::size_t strange = 0;
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = utf8_length(bytes, i);
    if (length > 0) {
      out.append(bytes.substr(i, length));
      i += length;
      continue;
    }
    // most such files were written in Latin-1, whose codes are the first 256 of Unicode
    const unsigned code = static_cast<unsigned char>(bytes[i]);
    if (strange++ == 0) {
      problems.warning(line_of(bytes, i), fmt::format("byte 0x{:02X} is not UTF-8; read as Latin-1", code),
                       "Save the file as UTF-8.");
    }
    out.push_back(static_cast<char>(0xC0u | (code >> 6u)));
    out.push_back(static_cast<char>(0x80u | (code & 0x3Fu)));
    ++i;
  }
  return out;
}

void drop_control_characters(std::string& text, Problems& problems) {
  bool said = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c >= 0x20 || c == '\t' || c == '\n' || c == '\r') continue;
    if (!said) {
      problems.error(line_of(text, i),
                     fmt::format("the control character 0x{:02X} can't be in XML; taken as a blank", c),
                     "Take it out; the file may be damaged.");
    }
    said = true;
    text[i] = ' ';
  }
}

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
    std::size_t i = open + 1;
    for (; i < text_.size() && (quote != 0 || text_[i] != '>'); ++i) {
      if (quote != 0) {
        quote = text_[i] == quote ? '\0' : quote;
      } else if (text_[i] == '"' || text_[i] == '\'') {
        quote = text_[i];
      }
    }
    const bool empty = !closing && i > open + 1 && i < text_.size() && text_[i - 1] == '/';
    at_ = std::min(i + 1, text_.size());
    any_ = true;
    depth_ += closing ? -1 : (empty ? 0 : 1);
    if (!closing && depth_ + (empty ? 1 : 0) > kMostUrdfDepth && deep_from_ == std::string::npos) {
      deep_from_ = open;
      deep_depth_ = depth_ - (empty ? 0 : 1);
    }
    if (deep_from_ != std::string::npos && depth_ <= deep_depth_ && (closing || empty)) cut_deep();
    return depth_ <= 0;
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
  bool any_ = false;
};

}  // namespace

Result<std::string> read_whole_file(const std::string& path, std::size_t most) {
  std::error_code fault;
  const std::filesystem::file_status status = std::filesystem::status(path, fault);
  const std::string shown = printable(path);
  if (!std::filesystem::exists(status)) {
    return Error{fmt::format("{}: there is no such file. Check the path; it is taken from the folder '{}'.", shown,
                             printable(std::filesystem::current_path(fault).string()))};
  }
  if (!std::filesystem::is_regular_file(status)) {
    return Error{fmt::format("{}: is a folder or a device, not a file. Give the path of a file.", shown)};
  }
  const std::uintmax_t size = std::filesystem::file_size(path, fault);
  if (fault || size > most) {
    return Error{fmt::format("{}: has {} bytes; at most {} are read. Split or simplify it.", shown, size, most)};
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file || !file.read(bytes.data(), static_cast<std::streamsize>(size))) {
    return Error{fmt::format("{}: can't be read. Check its permissions.", shown)};
  }
  return bytes;
}

Result<std::string> clean_urdf_text(std::string_view bytes, Problems& problems) {
  if (bytes.size() > kMostUrdfBytes) {
    return Error{fmt::format("has {} bytes; at most {} are read. Split or simplify it.", bytes.size(), kMostUrdfBytes)};
  }
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return Error{"is UTF-16, not UTF-8. Save the file as UTF-8."};
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) {
    problems.note(1, "the file starts with a byte order mark, which some readers refuse",
                  "Save it as UTF-8 without a byte order mark.");
    bytes.remove_prefix(3);
  }
  std::string text = to_utf8(bytes, problems);
  drop_control_characters(text, problems);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    return Error{"is empty. Give a file with a <robot> element."};
  }
  if (!Scanner(text, problems).run()) return Error{"holds no XML element. Give a file with a <robot> element."};
  return text;
}

}  // namespace limber
