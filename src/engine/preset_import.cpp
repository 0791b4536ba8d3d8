// Slots to presets, clients to rows.
#include "engine/preset_import.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber {

namespace {

using nlohmann::json;

constexpr int kDeepest = 64;

// the thing's path and the row's name; nothing where it is none
std::optional<std::pair<std::string, std::string>> place_of(const std::string& client) {
  std::string path;
  if (client.starts_with('/')) {
    path = client;
  } else {
    std::string_view left = client;
    if (left.find("::") == left.npos) path = "/scene";
    while (!left.empty()) {
      const std::size_t end = left.find("::");
      path += "/" + escape_name(left.substr(0, end));
      left.remove_prefix(end == left.npos ? left.size() : end + 2);
    }
  }
  const std::size_t slash = path.find_last_of('/');
  if (path.size() > 1000 || slash == 0 || slash + 1 == path.size()) return {};
  return std::pair{path.substr(0, slash), path.substr(slash + 1)};
}

// Max keeps every value as a list
std::optional<PresetRow> row_from(const std::string& name, const json& value, std::vector<double>& numbers) {
  const json list = value.is_array() ? value : json::array({value});
  if (list.size() == 1 && list[0].is_string()) {
    numbers.push_back(0);
    return PresetRow{name, RowType::choice, 1, {list[0].get<std::string>()}};
  }
  const bool all_numbers = std::all_of(list.begin(), list.end(), [](const json& v) { return v.is_number(); });
  const std::size_t n = list.size();
  if (!all_numbers || (n != 1 && n != 3 && n != 4)) return {};
  for (const json& v : list) numbers.push_back(v.get<double>());
  return PresetRow{name,
                   n == 1   ? RowType::number
                   : n == 3 ? RowType::vec3
                            : RowType::quat,
                   static_cast<std::uint32_t>(n),
                   {}};
}

class Import {
 public:
  Result<PresetsRead> run(const json& file) {
    const auto storage = file.find("pattrstorage");
    if (storage == file.end() || !storage->is_object() || !storage->contains("slots") ||
        !(*storage)["slots"].is_object()) {
      return Error{"it is no pattrstorage; in Max, it writes one by the message writejson"};
    }
    std::map<double, std::pair<std::string, const json*>> slots;  // by number
    for (const auto& [key, slot] : (*storage)["slots"].items()) {
      const std::optional<double> number = parse_number(key);
      if (number && slot.is_object()) {
        slots[*number] = {key, &slot};
      } else {
        read_.problems.push_back(fmt::format("slot '{}' is none", printable(shortened(key, 40))));
      }
    }
    for (const auto& [number, slot] : slots) take(slot.first, *slot.second);
    return std::move(read_);
  }

 private:
  void take(const std::string& key, const json& slot) {
    const std::string name = name_of(key, slot);
    PresetBuilder builder;
    std::map<std::string, std::pair<PresetClass, std::vector<double>>> things;
    const auto data = slot.find("data");
    if (data != slot.end() && data->is_object()) {
      for (const auto& [client, value] : data->items()) {
        const auto place = place_of(client);
        std::vector<double> numbers;
        const auto row = place ? row_from(place->second, value, numbers) : std::nullopt;
        if (!row || things[place->first].first.find(place->second) >= 0) {
          read_.problems.push_back(fmt::format("preset '{}': '{}' is left out: no row has such a value", name,
                                               printable(shortened(client, 100))));
          continue;
        }
        auto& [rows, values] = things[place->first];
        rows.add(*row);
        values.insert(values.end(), numbers.begin(), numbers.end());
      }
    }
    for (auto& [path, thing] : things) {
      const std::uint32_t number = builder.thing(path);
      if (thing.first.rows.empty()) continue;
      if (builder.has_rows(number)) {
        read_.problems.push_back(fmt::format("preset '{}': '{}' is written in two ways", name, printable(path)));
      } else {
        builder.give(number, std::move(thing.first), thing.second);
      }
    }
    read_.presets.push_back(builder.finish(name, {}));
  }

  std::string name_of(const std::string& key, const json& slot) {
    std::string name = fmt::format("slot {}", key);
    const auto said = slot.find("name");
    if (said != slot.end() && said->is_string() && !name_fault(said->get<std::string>()) && *said != "script")
      name = said->get<std::string>();
    for (int n = 2; !names_.insert(name).second; n++) name = fmt::format("{} {}", shortened(name, 100), n);
    return name;
  }

  PresetsRead read_;
  std::set<std::string> names_;
};

}  // namespace

Result<PresetsRead> import_pattrstorage(std::string_view text) {
  const auto too_deep = [](int depth, json::parse_event_t, json&) { return depth < kDeepest; };
  const json file = json::parse(text, too_deep, false);
  if (file.is_discarded() || !file.is_object())
    return Error{"it is no JSON file; in Max, pattrstorage writes one by the message writejson"};
  return Import().run(file);
}

}  // namespace limber
