// Formatting; a parser that works on events (SAX), so that a large file needs little memory beyond its content; import.
#include "engine/presets/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "sim/routes/route_list.h"

namespace limber::engine {

namespace {

using Json = nlohmann::json;

constexpr const char* kPresetVersionKey = "limber presets";
constexpr int kPresetVersion = 1;
constexpr std::size_t kMaxIgnoredDepth = 100;  // of values that are ignored
constexpr std::size_t kMaxPresets = 10000;
constexpr std::size_t kMaxProblems = 100;
constexpr std::size_t kMaxPath = 4096;
constexpr std::size_t kMaxProperties = 256;  // per node
constexpr std::size_t kMaxNumbers = 4096;    // per property
constexpr std::size_t kRouteTexts = 3;       // name, from, to

std::string json_quoted(std::string_view text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string value_text(const PresetProperty& property, const double* values) {
  if (property.type == PropertyType::choice) return json_quoted(property.labels[static_cast<std::size_t>(values[0])]);
  const bool flags = property.type == PropertyType::boolean || property.type == PropertyType::flags3;
  const auto one = [&](double v) {
    if (flags) return std::string(v != 0 ? "true" : "false");
    return v == 0 && std::signbit(v) ? "-0.0" : fmt::format("{}", v);  // "-0" would be read back as the integer 0
  };
  const bool list = property.type != PropertyType::boolean && property.type != PropertyType::number;
  if (!list) return one(values[0]);
  std::string text = "[";
  for (std::uint32_t i = 0; i < property.width; i++) text += (i == 0 ? "" : ", ") + one(values[i]);
  return text + "]";
}

void add_patterns(std::string& out, const char* key, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return;
  std::string list;
  for (const std::string& pattern : patterns) list += (list.empty() ? "" : ", ") + json_quoted(pattern);
  out += fmt::format(",\n      \"{}\": [{}]", key, list);
}

void add_preset(std::string& out, const Preset& preset) {
  out += fmt::format("    {{\n      \"name\": {}", json_quoted(preset.name));
  add_patterns(out, "rows", preset.selection.include);
  add_patterns(out, "except", preset.selection.except);
  if (preset.selection.poses) out += ",\n      \"poses\": true";
  if (preset.selection.velocities) out += ",\n      \"velocities\": true";
  const char* separator = ",\n      \"routes\": [";
  for (const PresetRoute& route : preset.routes) {
    out += fmt::format("{}\n        [{}, {}, {}]", separator, json_quoted(route.name), json_quoted(route.from),
                       json_quoted(route.to));
    separator = ",";
  }
  if (!preset.routes.empty()) out += "\n      ]";
  out += ",\n      \"values\": {";
  const PresetSchema& schema = *preset.schema;
  const char* comma = "";
  for (std::uint32_t i = 0; i < schema.nodes().size(); i++) {
    const PresetSchema::Node& node = schema.nodes()[i];
    const PresetLayout* const layout = schema.layout(node);
    if (layout == nullptr) continue;
    out += fmt::format("{}\n        {}: {{", comma, json_quoted(schema.path(i)));
    for (std::size_t k = 0; k < layout->properties.size(); k++) {
      out += fmt::format("{}\n          {}: {}", k == 0 ? "" : ",", json_quoted(layout->properties[k].name),
                         value_text(layout->properties[k], preset.values.data() + node.offset + layout->offsets[k]));
    }
    out += "\n        }";
    comma = ",";
  }
  out += "\n      }\n    }";
}

double number_of(const Json& value) { return value.is_boolean() ? (value.get<bool>() ? 1 : 0) : value.get<double>(); }

// Returns the property for a value, and appends its numbers; nothing if no property type has such a value.
std::optional<PresetProperty> property_of(const std::string& name, const Json& value, std::vector<double>& numbers) {
  if (value.is_string()) {
    numbers.push_back(0);
    return PresetProperty{name, PropertyType::choice, 1, {value.get<std::string>()}};
  }
  if (value.is_boolean() || value.is_number()) {
    numbers.push_back(number_of(value));
    return PresetProperty{name, value.is_boolean() ? PropertyType::boolean : PropertyType::number, 1, {}};
  }
  if (!value.is_array()) return {};
  const auto& list = value.get_ref<const Json::array_t&>();
  const std::size_t count = list.size();
  const bool flags = count == 3 && std::ranges::all_of(list, &Json::is_boolean);
  if (count == 0 || count >= kMaxNumbers || (!flags && !std::ranges::all_of(list, &Json::is_number))) return {};
  for (const Json& v : list) numbers.push_back(number_of(v));
  const PropertyType type = flags        ? PropertyType::flags3
                            : count == 3 ? PropertyType::vec3
                            : count == 4 ? PropertyType::quat
                                         : PropertyType::none;
  return PresetProperty{name, type, static_cast<std::uint32_t>(count), {}};
}

// The names of the presets that were read.
class PresetNames {
 public:
  // Adds the name, with a number appended if it is in use or `numbered`; returns it.
  std::string add(std::string name, bool numbered = false) {
    if (numbered || last_numbers_.contains(name)) {
      // starts at the last number used for this name: linear time even if thousands of presets have the same name
      int& n = last_numbers_.try_emplace(name, 1).first->second;
      const std::string base = shortened(name, 100);
      do name = fmt::format("{} {}", base, ++n);
      while (last_numbers_.contains(name));
    }
    last_numbers_.emplace(name, 1);
    return name;
  }

 private:
  std::map<std::string, int> last_numbers_;  // names in use, with the last number that was appended to each
};

class PresetParser : public Json::json_sax_t {
 public:
  Result<ParsedPresets> result(bool parsed) {
    if (!parsed || context_ != Context::end) return Error{error_.empty() ? "it is truncated" : error_};
    if (!has_version_) return Error{fmt::format("it is not a preset file: it has no \"{}\"", kPresetVersionKey)};
    return std::move(read_);
  }

  bool null() override { return scalar(nullptr); }
  bool boolean(bool v) override { return scalar(v); }
  bool number_integer(number_integer_t v) override { return scalar(static_cast<double>(v)); }
  bool number_unsigned(number_unsigned_t v) override { return scalar(static_cast<double>(v)); }
  bool number_float(number_float_t v, const string_t&) override { return scalar(v); }
  bool string(string_t& text) override { return scalar(std::move(text)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(true); }
  bool start_array(std::size_t) override { return open(false); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (skip_depth_ > 0) return true;
    std::string& key = context_ == Context::properties ? property_name_ : context_ == Context::nodes ? path_ : key_;
    key = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const Json::exception& exception) override {
    const std::string_view text = exception.what();
    if (text.find("unexpected end of input") != text.npos)
      return fail(fmt::format("it is truncated after {} bytes", position));
    const std::size_t name = text.find("] ");
    const std::string_view description = name == text.npos ? text : text.substr(name + 2);
    const std::string why = printable(shortened(description, 200));
    return fail(why.starts_with("parse error at") ? why : fmt::format("after {} bytes: {}", position, why));
  }

 private:
  enum class Context : std::uint8_t {
    start,
    root,
    presets,
    preset,
    patterns,
    routes,
    route,
    nodes,
    properties,
    list,
    end
  };
  // The objects and arrays that are expected.
  struct Nesting {
    Context outside;
    bool object;
    std::string_view key;  // empty: any
    Context inside;
  };
  static constexpr Nesting kNestings[] = {
      {Context::start, true, "", Context::root},           {Context::root, false, "presets", Context::presets},
      {Context::presets, true, "", Context::preset},       {Context::preset, true, "values", Context::nodes},
      {Context::preset, false, "rows", Context::patterns}, {Context::preset, false, "except", Context::patterns},
      {Context::nodes, true, "", Context::properties},     {Context::properties, false, "", Context::list},
      {Context::preset, false, "routes", Context::routes}, {Context::routes, false, "", Context::route},
  };

  bool fail(std::string why) {
    if (error_.empty()) error_ = std::move(why);
    return false;
  }
  void problem(std::string text) {
    if (read_.problems.size() < kMaxProblems) read_.problems.push_back(std::move(text));
  }

  bool open(bool object) {
    if (skip_depth_ > 0) return skip_depth_++ < kMaxIgnoredDepth || fail("it is nested too deep");
    const auto* const nesting = std::ranges::find_if(kNestings, [&](const Nesting& n) {
      return n.outside == context_ && n.object == object && (n.key.empty() || n.key == key_);
    });
    if (nesting == std::end(kNestings)) return ignore();
    context_ = nesting->inside;
    if (context_ == Context::preset) begin_preset();
    if (context_ == Context::properties) begin_node();
    if (context_ == Context::list) value_ = Json::array();
    if (context_ == Context::route) route_.clear();
    return true;
  }

  bool ignore() {
    if (context_ == Context::start || context_ == Context::end) return fail("it is not a preset file");
    skip_depth_ = 1;
    if (context_ == Context::properties || context_ == Context::list) {
      value_ = nullptr;
    } else {
      problem(fmt::format("'{}' is unknown to this version; ignored", printable(shortened(key_, 40))));
    }
    return true;
  }

  bool close() {
    if (skip_depth_ > 0) {
      if (--skip_depth_ == 0 && context_ == Context::properties) end_value();
      return true;
    }
    if (context_ == Context::preset) end_preset();
    if (context_ == Context::properties) end_node();
    if (context_ == Context::route) end_route();
    if (context_ == Context::list) end_value();
    context_ =
        context_ == Context::root ? Context::end : std::ranges::find(kNestings, context_, &Nesting::inside)->outside;
    return true;
  }

  bool scalar(Json v) {
    if (skip_depth_ > 0) return true;
    if (context_ == Context::properties) {
      value_ = std::move(v);
      end_value();
      return true;
    }
    if (context_ == Context::list) {
      if (value_.is_array() && value_.size() < kMaxNumbers) value_.push_back(std::move(v));
      return true;
    }
    if (context_ == Context::start) return fail("it is not a preset file");
    if (context_ == Context::root && key_ == kPresetVersionKey && v.is_number()) return check_version(v.get<double>());
    if (!accept(v)) report_unexpected(v);
    return true;
  }

  // False if the value is not expected here.
  bool accept(const Json& v) {
    if (context_ == Context::preset) return set_member(v);
    if (context_ == Context::route) return add_route_text(v);
    return context_ == Context::patterns && add_pattern(v);
  }

  // Sets a member of the preset; false if it has no such member.
  bool set_member(const Json& v) {
    if (key_ == "name" && v.is_string()) {
      name_ = v.get<std::string>();
    } else if (key_ == "poses" && v.is_boolean()) {
      selection_.poses = v.get<bool>();
    } else if (key_ == "velocities" && v.is_boolean()) {
      selection_.velocities = v.get<bool>();
    } else {
      return false;
    }
    return true;
  }

  bool add_pattern(const Json& v) {
    if (v.is_string()) (key_ == "rows" ? selection_.include : selection_.except).push_back(v.get<std::string>());
    return v.is_string();
  }

  bool add_route_text(const Json& v) {
    if (!v.is_string() || route_.size() >= kRouteTexts) return false;
    route_.push_back(v.get<std::string>());
    return true;
  }

  void end_route() {
    if (route_.size() == kRouteTexts && builder_.add_route({route_[0], route_[1], route_[2]})) return;
    problem(
        fmt::format("preset '{}': a route must be a list of a unique name and two addresses, and there are at most {}",
                    printable(name_), sim::RouteList::kMaxRoutes));
  }

  void report_unexpected(const Json& v) {
    const std::string text = v.is_number()   ? number_text(v.get<double>())
                             : v.is_string() ? v.get<std::string>()
                                             : v.dump();
    problem(fmt::format("'{}': unexpected value {}", printable(shortened(key_, 40)), printable(shortened(text, 40))));
  }

  bool check_version(double version) {
    has_version_ = true;
    return version == kPresetVersion ||
           fail(fmt::format("version {} is not supported; a newer Limber has written it", version));
  }

  void begin_preset() {
    builder_ = {};
    selection_ = {};
    name_.clear();
    key_.clear();
  }

  void begin_node() {
    layout_ = {};
    numbers_.clear();
  }

  void end_value() {
    const bool duplicate =
        std::ranges::find(layout_.properties, property_name_, &PresetProperty::name) != layout_.properties.end();
    const bool full = duplicate || layout_.properties.size() >= kMaxProperties;
    if (auto property = full ? std::nullopt : property_of(property_name_, value_, numbers_)) {
      layout_.add(std::move(*property));
    } else {
      problem(fmt::format("preset '{}', {}: '{}' {}", printable(name_), printable(shortened(path_, 100)),
                          printable(shortened(property_name_, 40)),
                          duplicate ? "is a duplicate" : "has a value of no known type"));
    }
  }

  void end_node() {
    if (layout_.properties.empty()) return;
    const bool valid = path_.size() <= kMaxPath && path_.starts_with('/');
    if (valid && builder_.add(path_, std::move(layout_), numbers_)) return;
    problem(fmt::format("preset '{}': '{}' {}", printable(name_), printable(shortened(path_, 100)),
                        valid ? "is a duplicate" : "is not a valid path"));
  }

  void end_preset() {
    const bool invalid = name_error(name_) || name_ == "script";
    const std::string unique = invalid ? names_.add("unnamed", true) : names_.add(name_);
    if (invalid) {
      problem(fmt::format("'{}' is not a valid name of a preset; renamed to '{}'", printable(shortened(name_, 40)),
                          unique));
    } else if (unique != name_) {
      problem(fmt::format("two presets are named '{}'; renamed the second to '{}'", printable(name_), unique));
    }
    if (read_.presets.size() >= kMaxPresets)
      return problem(fmt::format("more than {} presets: the others are ignored", kMaxPresets));
    // shares the schema with the previous preset if it is equal, so that blending them needs no alignment
    read_.presets.push_back(
        builder_.finish(unique, std::move(selection_), read_.presets.empty() ? nullptr : read_.presets.back()->schema));
  }

  ParsedPresets read_;
  std::string error_;
  Context context_ = Context::start;
  std::size_t skip_depth_ = 0;  // depth inside an ignored value; 0: none
  bool has_version_ = false;
  std::string key_;
  PresetNames names_;

  // the current preset, node and property
  PresetBuilder builder_;
  PresetSelection selection_;
  std::string name_;
  std::string path_;
  std::vector<std::string> route_;
  PresetLayout layout_;
  std::vector<double> numbers_;
  std::string property_name_;
  Json value_;
};

// Returns a member of an object, or null.
const Json* member(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found == object.end() ? nullptr : &*found;
}

// Returns the path of the node and the name of the property of a pattrstorage client; nothing if the name is invalid.
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

class PattrstorageImporter {
 public:
  Result<ParsedPresets> run(const Json& file) {
    const Json* const storage = member(file, "pattrstorage");
    const Json* const slots = storage == nullptr ? nullptr : member(*storage, "slots");
    if (slots == nullptr || !slots->is_object())
      return Error{"it is not a pattrstorage file; in Max, it writes one by the message writejson"};
    std::map<double, std::pair<std::string, const Json*>> by_number;
    for (const auto& [key, slot] : slots->items()) {
      const std::optional<double> number = parse_number(key);
      if (number && slot.is_object()) {
        by_number[*number] = {key, &slot};
      } else {
        read_.problems.push_back(fmt::format("'{}' is not a valid slot; ignored", printable(shortened(key, 40))));
      }
    }
    for (const auto& [number, slot] : by_number) convert(slot.first, *slot.second);
    return std::move(read_);
  }

 private:
  void convert(const std::string& key, const Json& slot) {
    const std::string name = name_of(key, slot);
    std::map<std::string, std::pair<PresetLayout, std::vector<double>>> nodes;
    if (const Json* const data = member(slot, "data"); data != nullptr && data->is_object()) {
      for (const auto& [client, value] : data->items()) {
        const auto target = split_client(client);
        if (target && add(nodes[target->first], target->second, value)) continue;
        read_.problems.push_back(fmt::format("preset '{}': '{}' is ignored: no property has such a value", name,
                                             printable(shortened(client, 100))));
      }
    }
    PresetBuilder builder;
    for (auto& [path, node] : nodes) {
      if (!builder.add(path, std::move(node.first), node.second))
        read_.problems.push_back(fmt::format("preset '{}': '{}' is a duplicate", name, printable(path)));
    }
    read_.presets.push_back(builder.finish(name, {}));
  }

  // Adds a value, which Max writes as a list, to a node. False if no property has such a value.
  static bool add(std::pair<PresetLayout, std::vector<double>>& node, const std::string& name, const Json& value) {
    std::vector<double> numbers;
    auto property = property_of(name, value.is_array() && value.size() == 1 ? value[0] : value, numbers);
    constexpr std::array kTypes{PropertyType::number, PropertyType::choice, PropertyType::vec3, PropertyType::quat};
    if (!property || std::ranges::find(kTypes, property->type) == kTypes.end() || node.first.find(name) >= 0)
      return false;
    node.first.add(std::move(*property));
    node.second.insert(node.second.end(), numbers.begin(), numbers.end());
    return true;
  }

  std::string name_of(const std::string& key, const Json& slot) {
    const Json* const entry = member(slot, "name");
    const std::string name = entry != nullptr && entry->is_string() ? entry->get<std::string>() : "";
    return names_.add(name_error(name) || name == "script" ? fmt::format("slot {}", key) : name);
  }

  ParsedPresets read_;
  PresetNames names_;
};

}  // namespace

std::string text_of(const PresetList& presets) {
  std::string out = fmt::format("{{\n  \"{}\": {},\n  \"presets\": [", kPresetVersionKey, kPresetVersion);
  for (const auto& preset : presets) {
    out += preset == presets.front() ? "\n" : ",\n";
    add_preset(out, *preset);
  }
  return out + (presets.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

Result<ParsedPresets> parse_presets(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return ParsedPresets{};
  PresetParser reader;
  return reader.result(Json::sax_parse(text, &reader));
}

Result<ParsedPresets> import_pattrstorage(std::string_view text) {
  const auto too_deep = [](int depth, Json::parse_event_t, Json&) { return depth < 64; };
  const Json file = Json::parse(text, too_deep, false);
  if (file.is_discarded() || !file.is_object())
    return Error{"it is not a JSON file; in Max, pattrstorage writes one by the message writejson"};
  return PattrstorageImporter().run(file);
}

}  // namespace limber::engine
