// Attribute values with defaults, orientations, and deferred reports.
#include "model/mjcf/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "base/text.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::array<std::string_view, 20> kDefaultElements{
    "mesh",   "material", "joint", "freejoint", "geom",     "site",        "camera", "light",    "pair",   "equality",
    "tendon", "general",  "motor", "position",  "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion"};
constexpr std::size_t kMaxClasses = 10'000;
constexpr std::size_t kMaxDeferred = 250;
constexpr double kMaxNumber = 1e12;

// Position and size limits of URDF files hold here as well; what exceeds them can't be simulated.
constexpr double kMaxPosition = 1e4;

std::string count_text(std::size_t min_count, std::size_t max_count) {
  return min_count == max_count ? fmt::format("{}", min_count) : fmt::format("{} to {}", min_count, max_count);
}

/// The rotation that turns z to a direction by the smallest angle.
Quat shortest_from_z(const Vec3& direction) {
  const Vec3 to = normalized(direction);
  if (glm::length(to) < 0.5) return quat_identity();
  const Vec3 axis = glm::cross(Vec3(0, 0, 1), to);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return to.z > 0 ? quat_identity() : quat_xyzw(1, 0, 0, 0);
  return quat_axis(axis / sine, fixed::atan2(sine, to.z));
}

}  // namespace

void MjcfReader::read_defaults() {
  bool first = true;
  for (const MjcfElement& e : document_.root.children) {
    if (e.name != "default") continue;
    const std::string* const written = e.attribute("class");
    if (first && written != nullptr) {
      classes_[0].name = *written;
      class_index_.emplace(*written, 0);
    }
    first = false;
    // several <default> elements add to the main class, unless they name another one
    add_class(e, written == nullptr || *written == classes_[0].name ? std::nullopt : std::optional<MjcfClass>(0));
  }
  class_index_.emplace("main", 0);
}

void MjcfReader::add_class(const MjcfElement& element, std::optional<MjcfClass> parent) {
  MjcfClass index = 0;
  if (parent) {
    const std::string* const written = element.attribute("class");
    if (written == nullptr) {
      error(element, "a nested <default> has no class; ignored", "Write <default class=\"…\">.");
      return;
    }
    if (classes_.size() >= kMaxClasses) {
      unsupported(element, fmt::format("more than {} default classes; the rest is ignored", kMaxClasses),
                  "Use fewer classes.", Severity::error);
      return;
    }
    index = classes_.size();
    const auto [at, is_new] = class_index_.try_emplace(*written, index);
    if (is_new) {
      classes_.push_back({*written, parent, {}});
    } else {
      index = at->second;  // a second element of the same class adds to it
    }
  }
  for (const MjcfElement& child : element.children) {
    if (child.name == "default") {
      add_class(child, index);
    } else {
      if (std::find(kDefaultElements.begin(), kDefaultElements.end(), child.name) == kDefaultElements.end()) {
        unknown(child, fmt::format("<{}> in <default> ignored: it has no defaults", printable_excerpt(child.name)),
                kDefaultElements, "Remove it.");
        continue;
      }
      classes_[index].elements.push_back(&child);
      check_attributes(child);
    }
  }
}

MjcfClass MjcfReader::class_of(const MjcfElement& element, MjcfClass inherited, const char* attribute) {
  const std::string* const written = element.attribute(attribute);
  if (written == nullptr) return inherited;
  const auto found = class_index_.find(*written);
  if (found != class_index_.end()) return found->second;
  if (!can_report()) return inherited;
  std::vector<std::string> names;
  for (const DefaultClass& known : classes_) {
    if (names.size() < 200) names.push_back(known.name);
  }
  error(element,
        fmt::format("{} names the class '{}', which does not exist{}; its defaults are missing", shown(element),
                    printable_excerpt(*written), name_hint(*written, names)),
        "Write the name of a <default class=\"…\"> of this file.");
  return inherited;
}

const std::string* MjcfReader::default_text(std::string_view tag, MjcfClass cls, std::string_view attribute) const {
  for (std::optional<MjcfClass> at = cls; at; at = classes_[*at].parent) {
    const std::vector<const MjcfElement*>& elements = classes_[*at].elements;
    for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
      if ((*e)->name != tag) continue;
      if (const std::string* const found = (*e)->attribute(attribute)) return found;
    }
  }
  return nullptr;
}

const std::string* MjcfReader::text(const MjcfElement& element, MjcfClass cls, std::string_view attribute) const {
  const std::string* const own = element.attribute(attribute);
  // the defaults of both kinds of tendons have one name
  const bool tendon = element.name == "fixed" || element.name == "spatial";
  const std::string_view tag = tendon ? std::string_view("tendon") : std::string_view(element.name);
  return own != nullptr ? own : default_text(tag, cls, attribute);
}

std::vector<double> MjcfReader::numbers(const MjcfElement& element, MjcfClass cls, const char* attribute,
                                        std::size_t min_count, std::size_t max_count) {
  const std::string* const written = text(element, cls, attribute);
  if (written == nullptr) return {};
  const auto reject = [&](const std::string& reason, const std::string& fix) {
    error(element,
          fmt::format("{}: {} '{}' {}; ignored", shown(element), attribute, printable_excerpt(*written), reason), fix);
    return std::vector<double>();
  };
  std::vector<double> out;
  for (std::string_view rest = trimmed(*written); !rest.empty(); rest = trimmed(rest)) {
    const std::size_t end = std::min(rest.find_first_of(kBlanks), rest.size());
    const NumberText read = read_number(rest.substr(0, end));
    if (*read.reason != '\0') return reject(read.reason, read.fix);
    if (std::abs(read.value) > kMaxNumber) return reject("is too large", "Write a number within 1e12.");
    if (out.size() == max_count)
      return reject(fmt::format("has more than {} numbers", max_count), "Remove the others.");
    out.push_back(read.value);
    rest.remove_prefix(end);
  }
  if (out.size() >= min_count) return out;
  return reject(fmt::format("has {} numbers, expected {}", out.size(), count_text(min_count, max_count)),
                "Write the numbers with blanks between them.");
}

double MjcfReader::number(const MjcfElement& element, MjcfClass cls, const char* attribute, double fallback) {
  const std::vector<double> read = numbers(element, cls, attribute, 1, 1);
  return read.empty() ? fallback : read[0];
}

std::optional<Vec3> MjcfReader::vector(const MjcfElement& element, MjcfClass cls, const char* attribute) {
  const std::vector<double> read = numbers(element, cls, attribute, 3, 3);
  if (read.empty()) return {};
  return Vec3(read[0], read[1], read[2]);
}

std::optional<bool> MjcfReader::flag(const MjcfElement& element, MjcfClass cls, const char* attribute) {
  const std::string* const written = text(element, cls, attribute);
  if (written == nullptr || *written == "auto") return {};
  if (*written == "true" || *written == "false") return *written == "true";
  error(element,
        fmt::format("{}: {} '{}' is neither true nor false; ignored", shown(element), attribute,
                    printable_excerpt(*written)),
        "Write true or false.");
  return {};
}

bool MjcfReader::limited(const MjcfElement& element, MjcfClass cls, const char* attribute, const char* range) {
  const bool has_range = text(element, cls, range) != nullptr;
  const std::optional<bool> written = flag(element, cls, attribute);
  return written ? *written && has_range : compiler.auto_limits && has_range;
}

Quat MjcfReader::euler(const std::vector<double>& angles) const {
  Quat out = quat_identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const char c = compiler.euler_order[i];
    const bool about_parent = c >= 'X' && c <= 'Z';
    const int axis = about_parent ? c - 'X' : c - 'x';
    const Quat turn =
        quat_axis(Vec3(axis == 0, axis == 1, axis == 2), compiler.degrees ? angles[i] * (kPi / 180) : angles[i]);
    out = about_parent ? turn * out : out * turn;
  }
  return out;
}

Quat MjcfReader::rotation(const MjcfElement& element, MjcfClass cls) {
  const auto fault = [&](const char* attribute) {
    error(element, fmt::format("{}: {} is not a direction; ignored", shown(element), attribute),
          "Write numbers that are not all 0.");
    return quat_identity();
  };
  if (const auto q = numbers(element, cls, "quat", 4, 4); !q.empty()) {
    const Quat read = quat_xyzw(q[1], q[2], q[3], q[0]);
    return glm::length(read) > 1e-9 ? glm::normalize(read) : fault("quat");
  }
  if (const auto a = numbers(element, cls, "axisangle", 4, 4); !a.empty()) {
    const Vec3 axis = normalized({a[0], a[1], a[2]});
    return glm::length(axis) > 0.5 ? quat_axis(axis, compiler.degrees ? a[3] * (kPi / 180) : a[3]) : fault("axisangle");
  }
  if (const auto e = numbers(element, cls, "euler", 3, 3); !e.empty()) return euler(e);
  if (const auto a = numbers(element, cls, "xyaxes", 6, 6); !a.empty()) {
    const Vec3 x = normalized({a[0], a[1], a[2]});
    const Vec3 written(a[3], a[4], a[5]);
    const Vec3 y = normalized(written - x * glm::dot(x, written));
    if (glm::length(x) < 0.5 || glm::length(y) < 0.5) return fault("xyaxes");
    return glm::normalize(glm::quat_cast(Mat3(x, y, glm::cross(x, y))));
  }
  if (const std::optional<Vec3> z = vector(element, cls, "zaxis")) {
    return glm::length(*z) > 0 ? shortest_from_z(*z) : fault("zaxis");
  }
  return quat_identity();
}

Pose MjcfReader::pose(const MjcfElement& element, MjcfClass cls) {
  Vec3 position = vector(element, cls, "pos").value_or(Vec3(0));
  if (std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)}) > kMaxPosition) {
    error(element, fmt::format("{}: pos is farther than 10000 m; ignored", shown(element)), "Write meters.");
    position = Vec3(0);
  }
  return {position, rotation(element, cls)};
}

std::string MjcfReader::name(const MjcfElement& element) {
  const std::string* const written = element.attribute("name");
  if (written == nullptr || written->empty()) return {};
  const std::optional<std::string> fault = name_error(*written);
  if (!fault) return *written;
  error(element, fmt::format("a <{}>'s name can't be used: {}; renamed", printable_excerpt(element.name), *fault),
        "Give it a short, printable name.");
  return {};
}

int MjcfReader::line_of(const MjcfElement& element) const {
  const MjcfSource& source = document_.sources[static_cast<std::size_t>(element.source)];
  return element.source == 0 ? element.line : source.line;
}

std::string MjcfReader::prefix(const MjcfElement& element) const {
  if (element.source == 0) return {};
  const MjcfSource& source = document_.sources[static_cast<std::size_t>(element.source)];
  return fmt::format("{} line {}: ", printable(std::filesystem::path(source.path).filename().string()), element.line);
}

std::string MjcfReader::shown(const MjcfElement& element) const {
  const std::string* const written = element.attribute("name");
  if (written == nullptr) return fmt::format("<{}>", printable_excerpt(element.name));
  return fmt::format("<{} name='{}'>", printable_excerpt(element.name), printable_excerpt(*written));
}

void MjcfReader::error(const MjcfElement& element, const std::string& text, const std::string& fix) {
  problems_.error(line_of(element), prefix(element) + text, fix);
}
void MjcfReader::warning(const MjcfElement& element, const std::string& text, const std::string& fix) {
  problems_.warning(line_of(element), prefix(element) + text, fix);
}
void MjcfReader::note(const MjcfElement& element, const std::string& text, const std::string& fix) {
  problems_.note(line_of(element), prefix(element) + text, fix);
}

bool MjcfReader::count_unsupported(const std::string& text) {
  const auto found = deferred_.find(text);
  if (found != deferred_.end()) ++found->second.count;
  return found != deferred_.end() || deferred_.size() >= kMaxDeferred;
}

void MjcfReader::unsupported(const MjcfElement& element, const std::string& text, const std::string& fix,
                             Severity severity) {
  if (count_unsupported(text)) return;
  Deferred& entry = deferred_[text];
  entry.count = 1;
  entry.first = &element;
  entry.fix = fix;
  entry.severity = severity;
}

void MjcfReader::unknown(const MjcfElement& element, const std::string& text, std::span<const std::string_view> known,
                         const std::string& fix, Severity severity) {
  if (count_unsupported(text)) return;
  const std::string_view suggestion = nearest_name(element.name, known);
  const bool misspelled = !suggestion.empty() && suggestion != element.name;
  unsupported(element, text, misspelled ? fmt::format("Did you mean <{}>?", suggestion) : fix,
              misspelled ? Severity::warning : severity);
}

void MjcfReader::report_deferred() {
  for (const auto& [what, entry] : deferred_) {
    const std::string places = entry.count > 1 ? fmt::format(" ({} places)", entry.count) : "";
    const std::string full = prefix(*entry.first) + what + places;
    if (entry.severity == Severity::note) {
      problems_.note(line_of(*entry.first), full, entry.fix);
    } else if (entry.severity == Severity::warning) {
      problems_.warning(line_of(*entry.first), full, entry.fix);
    } else {
      problems_.error(line_of(*entry.first), full, entry.fix);
    }
  }
  deferred_.clear();
  report_ignored();
}

}  // namespace limber::model
