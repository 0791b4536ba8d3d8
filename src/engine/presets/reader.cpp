// Parser for preset files: event-based (SAX), so that a large file needs little memory beyond its content.
#include "engine/presets/text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace limber {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxPresets = 10000;
constexpr std::size_t kMaxProblems = 100;
constexpr std::size_t kMaxPath = 4096;
constexpr std::size_t kMaxProperties = 256;  // per node
constexpr std::size_t kMaxNumbers = 4096;    // per property

// A value of a property during parsing: numbers, booleans or one string.
struct Value {
  std::vector<double> numbers;
  std::string label;
  enum class Kind : std::uint8_t { none, numbers, booleans, label, other } kind = Kind::none;

  void add(Kind new_kind, double number) {
    kind = kind == Kind::none || kind == new_kind ? new_kind : Kind::other;
    if (numbers.size() < kMaxNumbers) numbers.push_back(number);
  }
};

// Returns the property for a value; nothing if no property type has such a value.
std::optional<PresetProperty> property_of(const std::string& name, const Value& value, bool in_list) {
  const auto count = static_cast<std::uint32_t>(value.numbers.size());
  switch (value.kind) {
    case Value::Kind::label:
      if (in_list) return {};
      return PresetProperty{name, PropertyType::choice, 1, {value.label}};
    case Value::Kind::booleans:
      if (in_list && count != 3) return {};
      return PresetProperty{name, in_list ? PropertyType::flags3 : PropertyType::boolean, count, {}};
    case Value::Kind::numbers:
      if (!in_list) return PresetProperty{name, PropertyType::number, 1, {}};
      return PresetProperty{name,
                            count == 3   ? PropertyType::vec3
                            : count == 4 ? PropertyType::quat
                                         : PropertyType::none,
                            count,
                            {}};
    default:
      return {};
  }
}

class PresetParser : public Json::json_sax_t {
 public:
  Result<ParsedPresets> result(bool parsed) {
    if (!parsed || context_ != Context::end) return Error{error_.empty() ? "it is truncated" : error_};
    if (!version_) return Error{fmt::format("it is not a preset file: it has no \"{}\"", kPresetVersionKey)};
    return std::move(read_);
  }

  bool null() override { return scalar(Value::Kind::other, 0, "null"); }
  bool boolean(bool v) override { return scalar(Value::Kind::booleans, v ? 1 : 0, v ? "true" : "false"); }
  bool number_integer(number_integer_t v) override { return number(static_cast<double>(v)); }
  bool number_unsigned(number_unsigned_t v) override { return number(static_cast<double>(v)); }
  bool number_float(number_float_t v, const string_t&) override { return number(v); }
  bool binary(binary_t&) override { return false; }

  bool string(string_t& text) override {
    if (skip_depth_ > 0) return true;
    if (context_ == Context::preset && key_ == "name") {
      name_ = text;
    } else if (context_ == Context::patterns) {
      (key_ == "rows" ? selection_.include : selection_.except).push_back(text);
    } else if (context_ == Context::properties || context_ == Context::list) {
      value_.kind = value_.kind == Value::Kind::none ? Value::Kind::label : Value::Kind::other;
      value_.label = text;
      if (context_ == Context::properties) end_value(false);
    } else {
      return report_unexpected(printable(shortened(text, 40)));
    }
    return true;
  }

  bool key(string_t& name) override {
    if (skip_depth_ > 0) return true;
    if (context_ == Context::properties) {
      property_name_ = name;
      value_ = {};
    } else if (context_ == Context::nodes) {
      node_path_ = name;
    } else {
      key_ = name;
    }
    return true;
  }

  bool start_object(std::size_t) override {
    if (skip_depth_ > 0) return skip_depth_++ < kMaxDepth || fail("it is nested too deep");
    switch (context_) {
      case Context::start:
        context_ = Context::root;
        return true;
      case Context::presets:
        context_ = Context::preset;
        begin_preset();
        return true;
      case Context::preset:
        if (key_ != "values") return ignore(key_);
        context_ = Context::nodes;
        return true;
      case Context::nodes:
        context_ = Context::properties;
        begin_node();
        return true;
      case Context::properties:
      case Context::list:
        value_.kind = Value::Kind::other;
        skip_depth_ = 1;
        return true;
      default:
        return ignore(key_);
    }
  }

  bool end_object() override {
    if (skip_depth_ > 0) return end_skipped();
    if (context_ == Context::properties) {
      end_node();
      context_ = Context::nodes;
    } else if (context_ == Context::nodes) {
      context_ = Context::preset;
    } else if (context_ == Context::preset) {
      end_preset();
      context_ = Context::presets;
    } else {
      context_ = Context::end;
    }
    return true;
  }

  bool start_array(std::size_t) override {
    if (skip_depth_ > 0) return skip_depth_++ < kMaxDepth || fail("it is nested too deep");
    if (context_ == Context::root && key_ == "presets") {
      context_ = Context::presets;
    } else if (context_ == Context::preset && (key_ == "rows" || key_ == "except")) {
      context_ = Context::patterns;
    } else if (context_ == Context::properties) {
      context_ = Context::list;
    } else if (context_ == Context::list) {
      value_.kind = Value::Kind::other;
      skip_depth_ = 1;
    } else {
      return ignore(key_);
    }
    return true;
  }

  bool end_array() override {
    if (skip_depth_ > 0) return end_skipped();
    if (context_ == Context::list) {
      context_ = Context::properties;
      end_value(true);
    } else {
      context_ = context_ == Context::patterns ? Context::preset : Context::root;
    }
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
  static constexpr std::size_t kMaxDepth = 100;
  enum class Context : std::uint8_t { start, root, presets, preset, patterns, nodes, properties, list, end };

  bool fail(std::string why) {
    if (error_.empty()) error_ = std::move(why);
    return false;
  }
  void problem(std::string text) {
    if (read_.problems.size() < kMaxProblems) read_.problems.push_back(std::move(text));
  }
  // Reports a value that is not expected at this place.
  bool report_unexpected(std::string_view value) {
    if (context_ == Context::start) return fail("it is not a preset file");
    problem(fmt::format("'{}': unexpected value {}", printable(shortened(key_, 40)), value));
    return true;
  }
  bool ignore(std::string_view key) {
    if (context_ == Context::start || context_ == Context::end) return fail("it is not a preset file");
    problem(fmt::format("'{}' is unknown to this version; ignored", printable(shortened(key, 40))));
    skip_depth_ = 1;
    return true;
  }
  bool end_skipped() {
    if (--skip_depth_ == 0 && context_ == Context::properties) end_value(false);
    return true;
  }

  bool number(double v) {
    if (skip_depth_ > 0) return true;
    if (context_ == Context::root && key_ == kPresetVersionKey) {
      version_ = v;
      if (v == kPresetVersion) return true;
      return fail(fmt::format("version {} is not supported; a newer Limber has written it", v));
    }
    return scalar(Value::Kind::numbers, v, number_text(v));
  }

  bool scalar(Value::Kind kind, double v, std::string_view text) {
    if (skip_depth_ > 0) return true;
    if (context_ == Context::properties || context_ == Context::list) {
      value_.add(kind, v);
      if (context_ == Context::properties) end_value(false);
      return true;
    }
    if (context_ == Context::preset && kind == Value::Kind::booleans && (key_ == "poses" || key_ == "velocities")) {
      (key_ == "poses" ? selection_.poses : selection_.velocities) = v != 0;
      return true;
    }
    return report_unexpected(text);
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
    value_ = {};
  }

  void end_value(bool in_list) {
    const std::optional<PresetProperty> property = property_of(property_name_, value_, in_list);
    const bool duplicate = std::any_of(layout_.properties.begin(), layout_.properties.end(),
                                       [&](const PresetProperty& other) { return other.name == property_name_; });
    if (!property || duplicate || property->width == 0 || layout_.properties.size() >= kMaxProperties ||
        value_.numbers.size() >= kMaxNumbers) {
      problem(fmt::format("preset '{}', {}: '{}' {}", printable(name_), printable(shortened(node_path_, 100)),
                          printable(shortened(property_name_, 40)),
                          duplicate ? "is a duplicate" : "has a value of no known type"));
    } else {
      if (value_.kind == Value::Kind::label) value_.numbers.assign(1, 0);
      numbers_.insert(numbers_.end(), value_.numbers.begin(), value_.numbers.end());
      layout_.add(*property);
    }
    value_ = {};
  }

  void end_node() {
    if (layout_.properties.empty()) return;
    const bool path = node_path_.size() <= kMaxPath && node_path_.starts_with('/');
    const std::uint32_t node = path ? builder_.node(node_path_) : 0;
    if (!path || builder_.has_layout(node)) {
      problem(fmt::format("preset '{}': '{}' {}", printable(name_), printable(shortened(node_path_, 100)),
                          path ? "is a duplicate" : "is not a valid path"));
      return;
    }
    builder_.set_values(node, std::move(layout_), numbers_);
  }

  void end_preset() {
    if (const auto error = name_error(name_); error || name_ == "script") {
      const std::string new_name = unused_name("unnamed");
      problem(fmt::format("'{}' is not a valid name of a preset; renamed to '{}'", printable(shortened(name_, 40)),
                          new_name));
      name_ = new_name;
    } else if (name_in_use(name_)) {
      const std::string new_name = unused_name(name_);
      problem(fmt::format("two presets are named '{}'; renamed the second to '{}'", printable(name_), new_name));
      name_ = new_name;
    }
    if (read_.presets.size() < kMaxPresets) {
      read_.presets.push_back(builder_.finish(name_, std::move(selection_)));
      name_counters_.emplace(name_, 0);
    } else {
      problem(fmt::format("more than {} presets: the others are ignored", kMaxPresets));
    }
    share_schema();
  }

  // Shares the schema with the previous preset if it is equal, so that blending them needs no alignment.
  void share_schema() {
    if (read_.presets.size() < 2) return;
    std::shared_ptr<const Preset>& last = read_.presets.back();
    const std::shared_ptr<const Preset>& previous = read_.presets[read_.presets.size() - 2];
    if (*last->schema == *previous->schema)
      last = std::make_shared<const Preset>(Preset{last->name, last->selection, previous->schema, last->values});
  }

  bool name_in_use(const std::string& name) const { return name_counters_.contains(name); }
  std::string unused_name(const std::string& base) {
    // starts at the last number used for this name: linear time even if thousands of presets have the same name
    int& n = name_counters_.try_emplace(base, 0).first->second;
    n = std::max(n, 1);
    std::string name;
    do name = fmt::format("{} {}", shortened(base, 100), ++n);
    while (name_in_use(name));
    return name;
  }

  ParsedPresets read_;
  std::string error_;
  Context context_ = Context::start;
  std::size_t skip_depth_ = 0;  // depth inside an ignored value; 0: none
  std::optional<double> version_;
  std::string key_;
  std::map<std::string, int> name_counters_;  // names in use, with the last number that was appended to each

  // the current preset, node and property
  PresetBuilder builder_;
  PresetSelection selection_;
  std::string name_;
  std::string node_path_;
  PresetLayout layout_;
  std::vector<double> numbers_;
  std::string property_name_;
  Value value_;
};

}  // namespace

Result<ParsedPresets> parse_presets(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return ParsedPresets{};
  PresetParser reader;
  return reader.result(Json::sax_parse(text, &reader));
}

}  // namespace limber
