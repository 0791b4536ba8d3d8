// Edits the JSON of a cue file, so that the fields of other cues and their order stay; the cue parser checks the
// result.
#include "engine/cues/cue_edit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "engine/cues/cue_list.h"

namespace limber::engine {

namespace {

using EditedJson = nlohmann::ordered_json;

std::string quoted_json(const EditedJson& value) {
  return value.dump(-1, ' ', false, EditedJson::error_handler_t::replace);
}

// {"a": 1, "b": [1, 2]} in one line
std::string line_of_object(const EditedJson& object) {
  std::string line;
  for (const auto& [key, value] : object.items())
    line += fmt::format("{}{}: {}", line.empty() ? "{ " : ", ", quoted_json(key), quoted_json(value));
  return line + " }";
}

std::string text_of_cues(const EditedJson& json) {
  std::string text = "{\n";
  for (const auto& [key, value] : json.items()) {
    if (key != "cues") text += fmt::format("  {}: {},\n", quoted_json(key), quoted_json(value));
  }
  text += "  \"cues\": [";
  const EditedJson& cues = json["cues"];
  for (std::size_t i = 0; i < cues.size(); i++) text += (i == 0 ? "\n    " : ",\n    ") + line_of_object(cues[i]);
  return text + (cues.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

EditedJson json_of(const Arg& arg) {
  switch (arg.kind) {
    case Arg::Kind::number:
      if (arg.number == std::floor(arg.number) && std::abs(arg.number) < 1e15)
        return static_cast<std::int64_t>(arg.number);
      return arg.number;
    case Arg::Kind::boolean:
      return arg.number != 0;
    case Arg::Kind::text:
      return arg.text;
    default:
      return nullptr;
  }
}

class CueEditor {
 public:
  CueEditor(EditedJson& cues, const std::vector<Arg>& args) : cues_(cues), args_(args) {}

  Result<void> add(std::size_t current) {
    if (args_.empty() || args_.size() > 2 || !all_texts())
      return Error{"takes a name, and the name of a preset if it has one"};
    EditedJson cue = {{"name", args_[0].text}};
    if (args_.size() == 2) cue["preset"] = args_[1].text;
    cues_.insert(cues_.begin() + static_cast<std::ptrdiff_t>(std::min(current, cues_.size())), std::move(cue));
    return {};
  }
  Result<void> remove() {
    if (args_.size() != 1) return Error{"takes the name or the number of a cue"};
    const Result<std::size_t> index = find(args_[0]);
    if (!index) return Error{index.error()};
    cues_.erase(*index);
    return {};
  }
  Result<void> move() {
    if (args_.size() != 2 || !args_[1].is_numeric()) return Error{"takes a cue, and the number that it will have"};
    const Result<std::size_t> from = find(args_[0]);
    if (!from) return Error{from.error()};
    const Result<std::size_t> to = find(args_[1]);
    if (!to) return Error{to.error()};
    const EditedJson cue = cues_[*from];
    cues_.erase(*from);
    cues_.insert(cues_.begin() + static_cast<std::ptrdiff_t>(*to), cue);
    return {};
  }
  Result<void> set() {
    if (args_.size() != 3 || !args_[1].is_text())
      return Error{"takes a cue, a field (name, preset, time, easing, at, when, begin, follow, note) and its value"};
    const Result<std::size_t> index = find(args_[0]);
    if (!index) return Error{index.error()};
    const std::string& field = args_[1].text;
    if (field == "messages") return Error{"messages are edited in the file"};
    const bool is_empty = args_[2].kind == Arg::Kind::nil || (args_[2].is_text() && args_[2].text.empty());
    if (is_empty && field != "name") {
      cues_[*index].erase(field);
    } else {
      cues_[*index][field] = json_of(args_[2]);
    }
    return {};
  }

 private:
  bool all_texts() const {
    return std::ranges::all_of(args_, [](const Arg& arg) { return arg.is_text(); });
  }
  // Returns the index of a cue, given by its name or number.
  Result<std::size_t> find(const Arg& cue) const {
    std::vector<std::string> names;
    for (const EditedJson& known : cues_) names.push_back(known["name"].get<std::string>());
    if (cue.is_numeric()) {
      const bool known =
          cue.number >= 1 && cue.number <= static_cast<double>(names.size()) && cue.number == std::floor(cue.number);
      if (known) return static_cast<std::size_t>(cue.number) - 1;
      return Error{fmt::format("the number of a cue must be 1 to {}, got {}", names.size(), number_text(cue.number))};
    }
    const auto found = std::ranges::find(names, cue.text);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    return Error{
        fmt::format("there is no cue '{}'{}", printable(shortened(cue.text, 100)), name_hint(cue.text, names))};
  }

  EditedJson& cues_;
  const std::vector<Arg>& args_;
};

}  // namespace

Result<std::string> edited_cues(std::string_view text, const Message& edit, std::size_t current) {
  if (const Result<CueList> valid = parse_cues(text); !valid) return Error{valid.error()};
  const bool is_empty = text.find_first_not_of(" \t\r\n") == std::string_view::npos;
  EditedJson json = is_empty ? EditedJson{{"limber cues", 1}, {"cues", EditedJson::array()}} : EditedJson::parse(text);
  CueEditor editor(json["cues"], edit.args);
  const std::string address = normalized_name(edit.address);
  const std::string_view verb = std::string_view(address).substr(address.rfind('/') + 1);
  const Result<void> done = verb == "add"      ? editor.add(current)
                            : verb == "remove" ? editor.remove()
                            : verb == "move"   ? editor.move()
                                               : editor.set();
  if (!done) return Error{done.error()};
  std::string edited = text_of_cues(json);
  if (const Result<CueList> valid = parse_cues(edited); !valid) return Error{valid.error()};
  return edited;
}

}  // namespace limber::engine
