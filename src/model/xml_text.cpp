// Sanitizes a URDF's bytes: encoding, control characters, and (in xml_markup.cpp) the markup.
#include "model/xml_text.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/text.h"
#include "base/utf8.h"

namespace limber::model {

namespace {

std::string to_utf8(std::string_view bytes, Problems& problems) {
  std::string out;
  out.reserve(bytes.size());
  std::size_t invalid_bytes = 0;
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = utf8_length(bytes.substr(i));
    if (length > 0) {
      out.append(bytes.substr(i, length));
      i += length;
      continue;
    }
    // most such files are Latin-1; its codes equal the first 256 of Unicode
    const unsigned code = static_cast<unsigned char>(bytes[i]);
    if (invalid_bytes++ == 0) {
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
  bool reported = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c >= 0x20 || c == '\t' || c == '\n' || c == '\r') continue;
    if (!reported) {
      problems.error(line_of(text, i),
                     fmt::format("the control character 0x{:02X} is not allowed in XML; replaced by a blank", c),
                     "Remove it; the file may be damaged.");
    }
    reported = true;
    text[i] = ' ';
  }
}

}  // namespace

Result<std::string> read_whole_file(const std::string& path, std::size_t max_bytes) {
  std::error_code fault;
  const std::filesystem::file_status status = std::filesystem::status(path, fault);
  const std::string shown = printable(path);
  if (!std::filesystem::exists(status)) {
    return Error{fmt::format("{}: file not found. Check the path; it is relative to the folder '{}'.", shown,
                             printable(std::filesystem::current_path(fault).string()))};
  }
  if (!std::filesystem::is_regular_file(status)) {
    return Error{fmt::format("{}: is a folder or a device, not a file. Give the path of a file.", shown)};
  }
  const std::uintmax_t size = std::filesystem::file_size(path, fault);
  if (fault || size > max_bytes) {
    return Error{fmt::format("{}: has {} bytes; the limit is {}. Split or simplify it.", shown, size, max_bytes)};
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file || !file.read(bytes.data(), static_cast<std::streamsize>(size))) {
    return Error{fmt::format("{}: can't be read. Check its permissions.", shown)};
  }
  return bytes;
}

Result<std::string> clean_urdf_text(std::string_view bytes, Problems& problems) {
  if (bytes.size() > kMaxUrdfBytes) {
    return Error{fmt::format("has {} bytes; the limit is {}. Split or simplify it.", bytes.size(), kMaxUrdfBytes)};
  }
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return Error{"is UTF-16, not UTF-8. Save the file as UTF-8."};
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) {
    problems.note(1, "the file starts with a byte order mark, which some readers reject",
                  "Save it as UTF-8 without a byte order mark.");
    bytes.remove_prefix(3);
  }
  std::string text = to_utf8(bytes, problems);
  drop_control_characters(text, problems);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    return Error{"is empty. Give a file with a <robot> element."};
  }
  if (!clean_markup(text, problems)) return Error{"contains no XML element. Give a file with a <robot> element."};
  return text;
}

}  // namespace limber::model
