// Read event by event into presets, so that a file of many megabytes needs little more than what it holds.
#include "engine/preset_text.h"

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

constexpr std::size_t kMostPresets = 10000;
constexpr std::size_t kMostProblems = 100;
constexpr std::size_t kLongestPath = 4096;
constexpr std::size_t kMostRows = 256;      // of a thing
constexpr std::size_t kMostNumbers = 4096;  // of a row

// one value of a row as it comes: numbers, truths or one text
struct Value {
  std::vector<double> numbers;
  std::string label;
  enum class Kind : std::uint8_t { none, numbers, truths, label, other } kind = Kind::none;

  void take(Kind as, double number) {
    kind = kind == Kind::none || kind == as ? as : Kind::other;
    if (numbers.size() < kMostNumbers) numbers.push_back(number);
  }
};

// the row that such a value is of; nothing: no row has such a value
std::optional<PresetRow> row_of(const std::string& name, const Value& value, bool in_list) {
  const auto count = static_cast<std::uint32_t>(value.numbers.size());
  switch (value.kind) {
    case Value::Kind::label:
      if (in_list) return {};
      return PresetRow{name, RowType::choice, 1, {value.label}};
    case Value::Kind::truths:
      if (in_list && count != 3) return {};
      return PresetRow{name, in_list ? RowType::flags3 : RowType::boolean, count, {}};
    case Value::Kind::numbers:
      if (!in_list) return PresetRow{name, RowType::number, 1, {}};
      return PresetRow{name, count == 3 ? RowType::vec3 : count == 4 ? RowType::quat : RowType::none, count, {}};
    default:
      return {};
  }
}

class Reader : public Json::json_sax_t {
 public:
  Result<PresetsRead> result(bool parsed) {
    if (!parsed || where_ != Where::end)
      return Error{error_.empty() ? "it ends in the middle; the rest of it was lost" : error_};
    if (!version_) return Error{fmt::format("it is no file of presets: there is no \"{}\" in it", kPresetHead)};
    return std::move(read_);
  }

  bool null() override { return scalar(Value::Kind::other, 0, "null"); }
  bool boolean(bool v) override { return scalar(Value::Kind::truths, v ? 1 : 0, v ? "true" : "false"); }
  bool number_integer(number_integer_t v) override { return number(static_cast<double>(v)); }
  bool number_unsigned(number_unsigned_t v) override { return number(static_cast<double>(v)); }
  bool number_float(number_float_t v, const string_t&) override { return number(v); }
  bool binary(binary_t&) override { return false; }

  bool string(string_t& text) override {
    if (skip_ > 0) return true;
    if (where_ == Where::preset && key_ == "name") {
      name_ = text;
    } else if (where_ == Where::patterns) {
      (key_ == "rows" ? choice_.rows : choice_.except).push_back(text);
    } else if (where_ == Where::rows || where_ == Where::list) {
      value_.kind = value_.kind == Value::Kind::none ? Value::Kind::label : Value::Kind::other;
      value_.label = text;
      if (where_ == Where::rows) end_value(false);
    } else {
      return odd(printable(shortened(text, 40)));
    }
    return true;
  }

  bool key(string_t& name) override {
    if (skip_ > 0) return true;
    if (where_ == Where::rows) {
      row_ = name;
      value_ = {};
    } else if (where_ == Where::things) {
      thing_ = name;
    } else {
      key_ = name;
    }
    return true;
  }

  bool start_object(std::size_t) override {
    if (skip_ > 0) return skip_++ < kDeepest || fail("it is nested too deep");
    switch (where_) {
      case Where::start:
        where_ = Where::root;
        return true;
      case Where::presets:
        where_ = Where::preset;
        begin_preset();
        return true;
      case Where::preset:
        if (key_ != "values") return ignore(key_);
        where_ = Where::things;
        return true;
      case Where::things:
        where_ = Where::rows;
        begin_thing();
        return true;
      case Where::rows:
      case Where::list:
        value_.kind = Value::Kind::other;
        skip_ = 1;
        return true;
      default:
        return ignore(key_);
    }
  }

  bool end_object() override {
    if (skip_ > 0) return end_skipped();
    if (where_ == Where::rows) {
      end_thing();
      where_ = Where::things;
    } else if (where_ == Where::things) {
      where_ = Where::preset;
    } else if (where_ == Where::preset) {
      end_preset();
      where_ = Where::presets;
    } else {
      where_ = Where::end;
    }
    return true;
  }

  bool start_array(std::size_t) override {
    if (skip_ > 0) return skip_++ < kDeepest || fail("it is nested too deep");
    if (where_ == Where::root && key_ == "presets") {
      where_ = Where::presets;
    } else if (where_ == Where::preset && (key_ == "rows" || key_ == "except")) {
      where_ = Where::patterns;
    } else if (where_ == Where::rows) {
      where_ = Where::list;
    } else if (where_ == Where::list) {
      value_.kind = Value::Kind::other;
      skip_ = 1;
    } else {
      return ignore(key_);
    }
    return true;
  }

  bool end_array() override {
    if (skip_ > 0) return end_skipped();
    if (where_ == Where::list) {
      where_ = Where::rows;
      end_value(true);
    } else {
      where_ = where_ == Where::patterns ? Where::preset : Where::root;
    }
    return true;
  }

  bool parse_error(std::size_t place, const std::string&, const Json::exception& what) override {
    const std::string_view text = what.what();
    if (text.find("unexpected end of input") != text.npos)
      return fail(fmt::format("it ends in the middle, after {} bytes", place));
    const std::size_t name = text.find("] ");
    const std::string_view what_it_says = name == text.npos ? text : text.substr(name + 2);
    const std::string why = printable(shortened(what_it_says, 200));
    return fail(why.starts_with("parse error at") ? why : fmt::format("after {} bytes: {}", place, why));
  }

 private:
  static constexpr std::size_t kDeepest = 100;
  enum class Where : std::uint8_t { start, root, presets, preset, patterns, things, rows, list, end };

  bool fail(std::string why) {
    if (error_.empty()) error_ = std::move(why);
    return false;
  }
  void problem(std::string text) {
    if (read_.problems.size() < kMostProblems) read_.problems.push_back(std::move(text));
  }
  // a value that stands where none of its kind does
  bool odd(std::string_view what) {
    if (where_ == Where::start) return fail("it is no file of presets");
    problem(fmt::format("{} is nothing for '{}'", what, printable(shortened(key_, 40))));
    return true;
  }
  bool ignore(std::string_view key) {
    if (where_ == Where::start || where_ == Where::end) return fail("it is no file of presets");
    problem(fmt::format("'{}' says nothing to this version", printable(shortened(key, 40))));
    skip_ = 1;
    return true;
  }
  bool end_skipped() {
    if (--skip_ == 0 && where_ == Where::rows) end_value(false);
    return true;
  }

  bool number(double v) {
    if (skip_ > 0) return true;
    if (where_ == Where::root && key_ == kPresetHead) {
      version_ = v;
      if (v == kPresetVersion) return true;
      return fail(fmt::format("it is of version {}, which this Limber does not know; a newer one has written it", v));
    }
    return scalar(Value::Kind::numbers, v, number_text(v));
  }

  bool scalar(Value::Kind kind, double v, std::string_view text) {
    if (skip_ > 0) return true;
    if (where_ == Where::rows || where_ == Where::list) {
      value_.take(kind, v);
      if (where_ == Where::rows) end_value(false);
      return true;
    }
    if (where_ == Where::preset && kind == Value::Kind::truths && (key_ == "poses" || key_ == "velocities")) {
      (key_ == "poses" ? choice_.poses : choice_.velocities) = v != 0;
      return true;
    }
    return odd(text);
  }

  void begin_preset() {
    builder_ = {};
    choice_ = {};
    name_.clear();
    key_.clear();
  }

  void begin_thing() {
    rows_ = {};
    numbers_.clear();
    value_ = {};
  }

  void end_value(bool in_list) {
    const std::optional<PresetRow> row = row_of(row_, value_, in_list);
    const bool known =
        std::any_of(rows_.rows.begin(), rows_.rows.end(), [&](const PresetRow& r) { return r.name == row_; });
    if (!row || known || row->width == 0 || rows_.rows.size() >= kMostRows || value_.numbers.size() >= kMostNumbers) {
      problem(fmt::format("preset '{}', {}: '{}' {}", printable(name_), printable(shortened(thing_, 100)),
                          printable(shortened(row_, 40)),
                          known ? "stands there twice" : "has no value that any row has"));
    } else {
      if (value_.kind == Value::Kind::label) value_.numbers.assign(1, 0);
      numbers_.insert(numbers_.end(), value_.numbers.begin(), value_.numbers.end());
      rows_.add(*row);
    }
    value_ = {};
  }

  void end_thing() {
    if (rows_.rows.empty()) return;
    const bool path = thing_.size() <= kLongestPath && thing_.starts_with('/');
    const std::uint32_t thing = path ? builder_.thing(thing_) : 0;
    if (!path || builder_.has_rows(thing)) {
      problem(fmt::format("preset '{}': '{}' {}", printable(name_), printable(shortened(thing_, 100)),
                          path ? "stands there twice" : "is no path of a thing"));
      return;
    }
    builder_.give(thing, std::move(rows_), numbers_);
  }

  void end_preset() {
    if (const auto fault = name_fault(name_); fault || name_ == "script") {
      const std::string fresh = unused_name("unnamed");
      problem(fmt::format("a preset is called '{}'; it is '{}' now", printable(shortened(name_, 40)), fresh));
      name_ = fresh;
    } else if (taken(name_)) {
      const std::string fresh = unused_name(name_);
      problem(fmt::format("two presets are called '{}'; the second is '{}' now", printable(name_), fresh));
      name_ = fresh;
    }
    if (read_.presets.size() < kMostPresets) {
      read_.presets.push_back(builder_.finish(name_, std::move(choice_)));
      names_.emplace(name_, 0);
    } else {
      problem(fmt::format("more than {} presets: the others are left out", kMostPresets));
    }
    share_shape();
  }

  // presets of the same things have one shape, so that what lies between two is soon found
  void share_shape() {
    if (read_.presets.size() < 2) return;
    std::shared_ptr<const Preset>& last = read_.presets.back();
    const std::shared_ptr<const Preset>& before = read_.presets[read_.presets.size() - 2];
    if (*last->shape == *before->shape)
      last = std::make_shared<const Preset>(Preset{last->name, last->choice, before->shape, last->values});
  }

  bool taken(const std::string& name) const { return names_.contains(name); }
  std::string unused_name(const std::string& base) {
    // those of one name in a file of ten thousand: each looks from where the last one found
    int& n = names_.try_emplace(base, 0).first->second;
    n = std::max(n, 1);
    std::string name;
    do name = fmt::format("{} {}", shortened(base, 100), ++n);
    while (taken(name));
    return name;
  }

  PresetsRead read_;
  std::string error_;
  Where where_ = Where::start;
  std::size_t skip_ = 0;  // levels below what is passed over
  std::optional<double> version_;
  std::string key_;
  std::map<std::string, int> names_;  // and the number that was given last to one of it

  // the preset at hand, its thing, its row
  PresetBuilder builder_;
  PresetChoice choice_;
  std::string name_;
  std::string thing_;
  PresetClass rows_;
  std::vector<double> numbers_;
  std::string row_;
  Value value_;
};

}  // namespace

Result<PresetsRead> presets_of(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return PresetsRead{};
  Reader reader;
  return reader.result(Json::sax_parse(text, &reader));
}

}  // namespace limber
