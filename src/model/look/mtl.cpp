// Lines of material files: a keyword and its arguments.
#include "model/look/mtl.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "model/xml_numbers.h"

namespace limber::model {

namespace {

constexpr std::string_view kMtlBlank = " \t\r\v\f";

std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kMtlBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kMtlBlank));
  line.remove_prefix(word.size());
  return word;
}

class MtlReader {
 public:
  MtlReader(SoupLook& look, std::map<std::string, std::uint32_t, std::less<>>& materials)
      : look_(look), materials_(materials) {}

  void read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of("\n\r"), text.size());
      read_line(text.substr(0, std::min(text.find('#'), end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    finish();
  }

 private:
  void finish() {
    if (!in_material_ || materials_.contains(material_.name)) return;
    // black under a texture means that the texture alone is the color
    if (!material_.image.empty() && material_.color == Vec3(0)) material_.color = Vec3(1);
    const std::string name = material_.name;
    const std::uint32_t index = look_.add(std::move(material_));
    if (index != SoupLook::kNoMaterial) materials_.emplace(name, index);
  }

  void read_line(std::string_view line) {
    const std::string_view word = next_word(line);
    if (word == "newmtl") {
      finish();
      material_ = {};
      material_.name = std::string(trimmed(line));
      in_material_ = true;
      has_opacity_ = false;
    } else if (!in_material_) {
      return;
    } else if (word == "Kd") {
      read_color(line, material_.color);
    } else if (word == "Ke") {
      read_color(line, material_.emission);
    } else if (word == "d" || word == "Tr") {
      read_opacity(line, word == "Tr");
    } else if (same_name(word, "map_Kd")) {
      material_.image = image_name(line);
    } else if (word.starts_with("map_") || word == "bump" || word == "norm" || word == "disp" || word == "refl") {
      // the same image is often named again for the ambient color
      if (same_name(word, "map_Ka")) return;
      look_.report(Severity::note, "map",
                   fmt::format("material '{}': {} is not drawn", printable(material_.name), printable(word)),
                   "Nothing to do; only map_Kd is supported.");
    }
  }

  std::optional<double> number(std::string_view word) {
    const std::optional<double> value = parse_number(word);
    if (!value) {
      look_.report(Severity::warning, "number",
                   fmt::format("material '{}': '{}' is not a number; ignored", printable(material_.name),
                               printable(word.substr(0, 24))),
                   "Export the material file again.");
    }
    return value;
  }

  void read_color(std::string_view line, Vec3& color) {
    Vec3 read(0);
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = next_word(line);
      if (i == 1 && word.empty()) {  // one number for all channels
        color = Vec3(read.x);
        return;
      }
      const std::optional<double> value = number(word);
      if (!value) return;
      read[i] = std::clamp(*value, 0.0, 1.0);
    }
    color = read;
  }

  // d is the opacity, Tr its complement; d takes precedence
  void read_opacity(std::string_view line, bool inverse) {
    std::string_view word = next_word(line);
    if (word == "-halo") word = next_word(line);
    if (inverse && has_opacity_) return;
    const std::optional<double> value = number(word);
    if (!value) return;
    material_.alpha = std::clamp(inverse ? 1 - *value : *value, 0.0, 1.0);
    has_opacity_ = has_opacity_ || !inverse;
  }

  // the file name after the options, with their arguments; it may contain blanks
  std::string image_name(std::string_view line) {
    struct Option {
      std::string_view name;
      int arguments;
    };
    constexpr std::array<Option, 10> kOptions{{{"-blendu", 1},
                                               {"-blendv", 1},
                                               {"-boost", 1},
                                               {"-bm", 1},
                                               {"-cc", 1},
                                               {"-clamp", 1},
                                               {"-imfchan", 1},
                                               {"-mm", 2},
                                               {"-texres", 1},
                                               {"-type", 1}}};
    while (true) {
      line = trimmed(line);
      if (!line.starts_with("-")) return std::string(line);
      std::string_view rest = line;
      const std::string_view word = next_word(rest);
      const auto* const option =
          std::find_if(kOptions.begin(), kOptions.end(), [&](const Option& o) { return o.name == word; });
      const bool placement = word == "-o" || word == "-s" || word == "-t";
      if (option == kOptions.end() && !placement) return std::string(line);
      if (placement) {
        look_.report(Severity::note, "placement",
                     fmt::format("material '{}': option {} of map_Kd ignored", printable(material_.name), word),
                     "Change the texture coordinates instead.");
      }
      // up to three numbers
      for (int i = 0; i < (placement ? 3 : option->arguments); ++i) {
        std::string_view after = rest;
        const std::string_view argument = next_word(after);
        if (placement && !parse_number(argument)) break;
        rest = after;
      }
      line = rest;
    }
  }

  SoupLook& look_;
  std::map<std::string, std::uint32_t, std::less<>>& materials_;
  MeshMaterial material_;
  bool in_material_ = false;
  bool has_opacity_ = false;
};

}  // namespace

void read_mtl(std::string_view text, SoupLook& look, std::map<std::string, std::uint32_t, std::less<>>& materials) {
  MtlReader(look, materials).read(text);
}

}  // namespace limber::model
