// Conversion of slots to presets and of clients to properties.
#include "engine/presets/pattrstorage.h"

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

constexpr int kMaxDepth = 64;

// Returns the path of the node and the name of the property; nothing if the name is invalid.
std::optional<std::pair<std::string, std::string>> split_client(const std::string& client) {
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

// Converts a value, which Max writes as a list. Nothing if no property has such a value.
std::optional<PresetProperty> property_from(const std::string& name, const json& value, std::vector<double>& numbers) {
  const json list = value.is_array() ? value : json::array({value});
  if (list.size() == 1 && list[0].is_string()) {
    numbers.push_back(0);
    return PresetProperty{name, PropertyType::choice, 1, {list[0].get<std::string>()}};
  }
  const bool all_numbers = std::all_of(list.begin(), list.end(), [](const json& v) { return v.is_number(); });
  const std::size_t n = list.size();
  if (!all_numbers || (n != 1 && n != 3 && n != 4)) return {};
  for (const json& v : list) numbers.push_back(v.get<double>());
  return PresetProperty{name,
                        n == 1   ? PropertyType::number
                        : n == 3 ? PropertyType::vec3
                                 : PropertyType::quat,
                        static_cast<std::uint32_t>(n),
                        {}};
}

class PattrstorageImporter {
 public:
  Result<ParsedPresets> run(const json& file) {
    const auto storage = file.find("pattrstorage");
    if (storage == file.end() || !storage->is_object() || !storage->contains("slots") ||
        !(*storage)["slots"].is_object()) {
      return Error{"it is not a pattrstorage file; in Max, it writes one by the message writejson"};
    }
    std::map<double, std::pair<std::string, const json*>> slots;  // by number
    for (const auto& [key, slot] : (*storage)["slots"].items()) {
      const std::optional<double> number = parse_number(key);
      if (number && slot.is_object()) {
        slots[*number] = {key, &slot};
      } else {
        read_.problems.push_back(fmt::format("'{}' is not a valid slot; ignored", printable(shortened(key, 40))));
      }
    }
    for (const auto& [number, slot] : slots) convert_slot(slot.first, *slot.second);
    return std::move(read_);
  }

 private:
  void convert_slot(const std::string& key, const json& slot) {
    const std::string name = name_of(key, slot);
    PresetBuilder builder;
    std::map<std::string, std::pair<PresetLayout, std::vector<double>>> nodes;
    const auto data = slot.find("data");
    if (data != slot.end() && data->is_object()) {
      for (const auto& [client, value] : data->items()) {
        const auto target = split_client(client);
        std::vector<double> numbers;
        const auto property = target ? property_from(target->second, value, numbers) : std::nullopt;
        if (!property || nodes[target->first].first.find(target->second) >= 0) {
          read_.problems.push_back(fmt::format("preset '{}': '{}' is ignored: no property has such a value", name,
                                               printable(shortened(client, 100))));
          continue;
        }
        auto& [layout, values] = nodes[target->first];
        layout.add(*property);
        values.insert(values.end(), numbers.begin(), numbers.end());
      }
    }
    for (auto& [path, node] : nodes) {
      const std::uint32_t node_index = builder.node(path);
      if (node.first.properties.empty()) continue;
      if (builder.has_layout(node_index)) {
        read_.problems.push_back(fmt::format("preset '{}': '{}' is a duplicate", name, printable(path)));
      } else {
        builder.set_values(node_index, std::move(node.first), node.second);
      }
    }
    read_.presets.push_back(builder.finish(name, {}));
  }

  std::string name_of(const std::string& key, const json& slot) {
    std::string name = fmt::format("slot {}", key);
    const auto name_entry = slot.find("name");
    if (name_entry != slot.end() && name_entry->is_string() && !name_error(name_entry->get<std::string>()) &&
        *name_entry != "script")
      name = name_entry->get<std::string>();
    for (int n = 2; !names_.insert(name).second; n++) name = fmt::format("{} {}", shortened(name, 100), n);
    return name;
  }

  ParsedPresets read_;
  std::set<std::string> names_;
};

}  // namespace

Result<ParsedPresets> import_pattrstorage(std::string_view text) {
  const auto too_deep = [](int depth, json::parse_event_t, json&) { return depth < kMaxDepth; };
  const json file = json::parse(text, too_deep, false);
  if (file.is_discarded() || !file.is_object())
    return Error{"it is not a JSON file; in Max, pattrstorage writes one by the message writejson"};
  return PattrstorageImporter().run(file);
}

}  // namespace limber
