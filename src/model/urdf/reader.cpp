// Attributes of URDF elements: numbers, vectors, origins, colors.
#include "model/urdf/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/text.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr NumberRange kQuatRange{-1e6, 1e6, "within 1e6"};
/// True for notations that urdfdom or similar readers reject: "+1", ".5", "5.", leading or trailing blanks.
bool is_nonstandard(std::string_view text) {
  if (kBlanks.find(text.front()) != std::string_view::npos || kBlanks.find(text.back()) != std::string_view::npos) {
    return true;
  }
  const char last = text.back();
  const std::string_view digits = text.front() == '-' ? text.substr(1) : text;
  return text.front() == '+' || last == '.' || (!digits.empty() && digits.front() == '.');
}

}  // namespace

std::string_view UrdfReader::name_of(const Element& element) const {
  std::string_view name = element.Name();
  if (!prefix_.empty() && name.starts_with(prefix_)) name.remove_prefix(prefix_.size());
  return name;
}

const UrdfReader::Element* UrdfReader::child(const Element& parent, std::string_view name) const {
  const Element* element = parent.FirstChildElement();
  while (element && name_of(*element) != name) element = element->NextSiblingElement();
  return element;
}

const UrdfReader::Element* UrdfReader::unique_child(const Element& parent, std::string_view name,
                                                    const std::string& owner) {
  const Element* found = child(parent, name);
  if (!found) return nullptr;
  for (const Element* next = found->NextSiblingElement(); next; next = next->NextSiblingElement()) {
    if (name_of(*next) != name) continue;
    problems.warning(next->GetLineNum(), fmt::format("{} has more than one <{}>; using the first", owner, name),
                     "Remove the others.");
    break;
  }
  return found;
}

std::optional<double> UrdfReader::parse_in_range(std::string_view text, int line, const std::string& where,
                                                 const NumberRange& range) {
  const std::string_view digits = trimmed(text);
  const NumberText read = read_number(digits);
  if (*read.reason) {
    problems.error(line, fmt::format("{}: '{}' {}; ignored", where, printable_excerpt(text), read.reason), read.fix);
    return std::nullopt;
  }
  if (read.value < range.min || read.value > range.max) {
    problems.error(line, fmt::format("{}: '{}' is out of range; ignored", where, printable_excerpt(text)),
                   fmt::format("Write a number {}.", range.description));
    return std::nullopt;
  }
  if (is_nonstandard(text) && nonstandard_numbers_++ == 0) {
    nonstandard_line_ = line;
    nonstandard_text_ = printable_excerpt(text);
  }
  return read.value;
}

std::optional<double> UrdfReader::number(const Element& element, const char* attribute, const std::string& owner,
                                         const NumberRange& range) {
  const tinyxml2::XMLAttribute* found = element.FindAttribute(attribute);
  if (!found) return std::nullopt;
  const std::string where = fmt::format("{}: <{} {}>", owner, name_of(element), attribute);
  return parse_in_range(found->Value(), found->GetLineNum(), where, range);
}

std::optional<Vec3> UrdfReader::vector(const Element& element, const char* attribute, const std::string& owner,
                                       const NumberRange& range) {
  std::array<double, 3> out{};
  if (!numbers(element, attribute, owner, range, out)) return std::nullopt;
  return Vec3(out[0], out[1], out[2]);
}

// false if the attribute is absent, or invalid (which is reported)
bool UrdfReader::numbers(const Element& element, const char* attribute, const std::string& owner,
                         const NumberRange& range, std::span<double> out) {
  const tinyxml2::XMLAttribute* found = element.FindAttribute(attribute);
  if (!found) return false;
  const std::string where = fmt::format("{}: <{} {}>", owner, name_of(element), attribute);
  const std::string_view text = found->Value();
  std::size_t at = text.find_first_not_of(kBlanks);
  std::size_t count = 0;
  for (; at != std::string_view::npos; ++count) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    if (count < out.size()) {
      const std::optional<double> value = parse_in_range(text.substr(at, end - at), found->GetLineNum(), where, range);
      if (!value) return false;
      out[count] = *value;
    }
    at = text.find_first_not_of(kBlanks, end);
  }
  if (count == out.size() && text.find_first_of("\t\r\n") != std::string_view::npos && nonstandard_numbers_++ == 0) {
    nonstandard_line_ = found->GetLineNum();
    nonstandard_text_ = printable_excerpt(text);
  }
  if (count == out.size()) return true;
  problems.error(found->GetLineNum(),
                 fmt::format("{}: '{}' has {}, expected {}; ignored", where, printable_excerpt(text),
                             counted(count, "number"), out.size()),
                 fmt::format("Write {} numbers with blanks between them.", out.size() == 3 ? "three" : "four"));
  return false;
}

UrdfOrigin UrdfReader::origin(const Element& parent, const std::string& owner) {
  UrdfOrigin out;
  const Element* element = unique_child(parent, "origin", owner);
  if (!element) return out;
  out.xyz = vector(*element, "xyz", owner, kPositionRange).value_or(Vec3(0));
  out.rpy = vector(*element, "rpy", owner, kAngleRange).value_or(Vec3(0));
  check_attributes(*element, {"xyz", "rpy", "quat_xyzw"});
  std::array<double, 4> quat{};
  if (!numbers(*element, "quat_xyzw", owner, kQuatRange, quat)) return out;
  const Quat read = quat_xyzw(quat[0], quat[1], quat[2], quat[3]);
  const double length = glm::length(read);
  if (length < 1e-9) {
    problems.error(element->GetLineNum(),
                   fmt::format("{}: <origin quat_xyzw> is 0 0 0 0, which is not a rotation; ignored", owner),
                   "Write the unit quaternion as x y z w; no rotation is 0 0 0 1.");
    return out;
  }
  if (element->Attribute("rpy") != nullptr) {
    problems.warning(element->GetLineNum(), fmt::format("{}: <origin> has both rpy and quat_xyzw; rpy ignored", owner),
                     "Write one of the two.");
  }
  if (std::abs(length - 1) > 1e-3) {
    problems.note(element->GetLineNum(),
                  fmt::format("{}: <origin quat_xyzw> has length {:.6g}, not 1; normalized", owner, length),
                  "Write a unit quaternion.");
  }
  out.quat = read / length;
  return out;
}

bool UrdfReader::material(const Element& material, const std::string& owner, UrdfMaterial& out) {
  if (const Element* texture = child(material, "texture")) {
    check_attributes(*texture, {"filename"});
    if (const char* uri = texture->Attribute("filename")) out.texture_uri = trimmed(uri);
    if (out.texture_uri.empty()) {
      problems.warning(texture->GetLineNum(), owner + ": <texture> has no filename; ignored",
                       "Write <texture filename=\"…\"/> with a PNG or JPEG file.");
    }
  }
  const Element* element = child(material, "color");
  if (!element) return !out.empty();
  check_attributes(*element, {"rgba"});
  const char* text = element->Attribute("rgba");
  std::vector<double> parts;
  bool good = text != nullptr;
  for (std::string_view rest = text ? text : ""; good && !trimmed(rest).empty();) {
    rest = trimmed(rest);
    const std::size_t end = std::min(rest.find_first_of(kBlanks), rest.size());
    const NumberText read = read_number(rest.substr(0, end));
    good = *read.reason == '\0' && parts.size() < 4;
    parts.push_back(std::clamp(read.value, 0.0, 1.0));
    rest.remove_prefix(end);
  }
  if (!good || (parts.size() != 3 && parts.size() != 4)) {
    problems.warning(
        element->GetLineNum(),
        fmt::format("{}: <color rgba='{}'> is not a color; ignored", owner, printable_excerpt(text ? text : "")),
        "Write four numbers from 0 to 1: red green blue alpha.");
    return !out.empty();
  }
  out.color = Vec3(parts[0], parts[1], parts[2]);
  out.alpha = parts.size() == 4 ? parts[3] : 1;
  return true;
}

void UrdfReader::check_attributes(const Element& element, std::initializer_list<std::string_view> known) {
  constexpr std::size_t kMaxKinds = 200;
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a; a = a->Next()) {
    const std::string_view name = a->Name();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    if (name == "concave" || name == "xmlns" || name.starts_with("xmlns:")) continue;
    const std::pair key(std::string(name_of(element)), std::string(name));
    if (unused_attributes_.size() >= kMaxKinds && !unused_attributes_.contains(key)) continue;
    UnusedAttribute& entry = unused_attributes_[key];
    if (entry.count++ > 0) continue;
    entry.line = a->GetLineNum();
    entry.known = known;
  }
}

void UrdfReader::report_attributes() {
  for (const auto& [key, entry] : unused_attributes_) {
    const auto& [element, attribute] = key;
    std::string text =
        fmt::format("<{}> has no attribute '{}'; ignored", printable(element), printable_excerpt(attribute));
    if (entry.count > 1) text += fmt::format(" in {} places", entry.count);
    const std::string_view suggestion = nearest_name(attribute, entry.known);
    if (!suggestion.empty()) {
      problems.warning(entry.line, std::move(text), fmt::format("Did you mean '{}'?", suggestion));
    } else {
      problems.note(entry.line, std::move(text), "Nothing to do, unless you expected an effect.");
    }
  }
}

void UrdfReader::report_deferred() {
  report_attributes();
  if (nonstandard_numbers_ == 0) return;
  problems.note(
      nonstandard_line_,
      fmt::format("{} a notation that some readers reject, first '{}'; accepted",
                  counted(nonstandard_numbers_, "number uses", "numbers use"), nonstandard_text_),
      "Write digits on both sides of the point, no '+', and single blanks between numbers only: 0.5, 5.0, 1.");
}

}  // namespace limber::model
