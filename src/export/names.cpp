// Replaces or encodes characters that have a meaning in the file format.
#include "export/names.h"

#include <fmt/format.h>

#include "base/utf8.h"

namespace limber::exporter {

namespace {

constexpr std::size_t kMaxBytes = 120;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string with_underscores(std::string_view name, std::string_view replaced) {
  std::string out(name);
  for (char& c : out) {
    if (is_control(c) || replaced.find(c) != std::string_view::npos) c = '_';
  }
  return out.empty() ? "_" : out;
}

}  // namespace

std::string UniqueNames::unique(std::string_view name) {
  std::string candidate(name);
  for (int n = 2; !used_.insert(candidate).second; n++) candidate = fmt::format("{}-{}", name, n);
  return candidate;
}

std::string sanitize_bvh_name(std::string_view name) { return with_underscores(name, " \t{}"); }

std::string sanitize_file_name(std::string_view name) {
  std::string out = with_underscores(name, "/\\:*?\"<>|");
  if (out.front() == '.') out.front() = '_';
  return std::string(utf8_prefix(out, kMaxBytes));
}

std::string percent_encode(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

}  // namespace limber::exporter
