// Characters that mean something to who reads become others.
#include "motion/names.h"

#include <fmt/format.h>

namespace limber {

namespace {

constexpr std::size_t kMostBytes = 120;

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string with_bars(std::string_view name, std::string_view instead_of) {
  std::string out(name);
  for (char& c : out) {
    if (is_control(c) || instead_of.find(c) != std::string_view::npos) c = '_';
  }
  return out.empty() ? "_" : out;
}

}  // namespace

std::string UniqueNames::unique(std::string_view name) {
  std::string given(name);
  for (int n = 2; !given_.insert(given).second; n++) given = fmt::format("{}-{}", name, n);
  return given;
}

std::string word_name(std::string_view name) { return with_bars(name, " \t{}"); }

std::string file_name(std::string_view name) {
  std::string out = with_bars(name, "/\\:*?\"<>|");
  if (out.front() == '.') out.front() = '_';
  if (out.size() <= kMostBytes) return out;
  std::size_t end = kMostBytes;
  while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xc0u) == 0x80u) end--;  // no letter is cut in two
  return out.substr(0, end);
}

std::string uri_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

}  // namespace limber
