// Sanitizes a model file's bytes: encoding, control characters, and (in xml_markup.cpp) the markup.
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

Result<std::string> clean_xml_text(std::string_view bytes, const XmlFormat& format, Problems& problems) {
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
    return Error{fmt::format("is empty. Give a file with a <{}> element.", format.root)};
  }
  if (!clean_markup(text, format, problems)) {
    return Error{fmt::format("contains no XML element. Give a file with a <{}> element.", format.root)};
  }
  return text;
}

Result<std::string> clean_urdf_text(std::string_view bytes, Problems& problems) {
  return clean_xml_text(bytes, kUrdfFormat, problems);
}

std::string_view root_element_name(std::string_view bytes) {
  std::size_t at = bytes.find('<');
  while (at != std::string_view::npos && at + 1 < bytes.size()) {
    const std::string_view rest = bytes.substr(at);
    if (rest[1] != '?' && rest[1] != '!') return rest.substr(1, rest.find_first_of(" \t\r\n/>", 1) - 1);
    const std::string_view end = rest[1] == '?' ? "?>" : rest.starts_with("<!--") ? "-->" : ">";
    const std::size_t found = rest.find(end, 2);
    if (found == std::string_view::npos) return {};
    at = bytes.find('<', at + found + end.size());
  }
  return {};
}

}  // namespace limber::model
