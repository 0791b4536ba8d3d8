// Shapes, and two presets brought into one.
#include "engine/preset.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

int PresetClass::find(std::string_view name) const {
  for (std::size_t i = 0; i < rows.size(); i++) {
    if (same_name(rows[i].name, name)) return static_cast<int>(i);
  }
  return -1;
}

std::string PresetShape::path(std::uint32_t thing) const {
  if (thing == 0) return "/";
  std::string path;
  for (std::uint32_t at = thing; at != 0; at = things_[at].parent) path = "/" + escape_name(name(things_[at])) + path;
  return path;
}

std::size_t PresetShape::row_count() const {
  std::size_t count = 0;
  for (const Thing& thing : things_) count += thing.rows == kNoRows ? 0 : classes_[thing.rows]->rows.size();
  return count;
}

bool PresetShape::operator==(const PresetShape& other) const {
  const auto same_class = [&](std::uint32_t a, std::uint32_t b) {
    if (a == kNoRows || b == kNoRows) return a == b;
    return classes_[a] == other.classes_[b] || *classes_[a] == *other.classes_[b];
  };
  return names_ == other.names_ && std::equal(things_.begin(), things_.end(), other.things_.begin(),
                                              other.things_.end(), [&](const Thing& a, const Thing& b) {
                                                return a.parent == b.parent && a.at == b.at && a.name_at == b.name_at &&
                                                       a.name_size == b.name_size && same_class(a.rows, b.rows);
                                              });
}

void PresetShape::expect(std::size_t things) {
  constexpr std::size_t kName = 8;  // most are shorter
  things_.reserve(things);
  names_.reserve(things * kName);
}

std::uint32_t PresetShape::add(std::uint32_t parent, std::string_view name) {
  things_.push_back(
      {parent, kNoRows, 0, static_cast<std::uint32_t>(names_.size()), static_cast<std::uint32_t>(name.size())});
  names_ += name;
  return static_cast<std::uint32_t>(things_.size() - 1);
}

void PresetShape::give(std::uint32_t thing, std::uint32_t rows) {
  things_[thing].rows = rows;
  things_[thing].at = width_;
  width_ += classes_[rows]->width;
}

std::uint32_t PresetShape::add_all(const PresetShape& from, std::uint32_t thing, std::uint32_t parent) {
  const auto made = static_cast<std::uint32_t>(things_.size());
  const std::uint32_t names = from.things_[thing].name_at;
  const std::uint32_t numbers = from.first_number(thing);
  const auto names_here = static_cast<std::uint32_t>(names_.size());
  const std::uint32_t numbers_here = width_;
  std::uint32_t i = thing;
  do {
    Thing its = from.things_[i];
    its.parent = i == thing ? parent : its.parent - thing + made;
    its.name_at += names_here - names;
    if (its.rows != kNoRows) {
      its.at += numbers_here - numbers;
      width_ = its.at + classes_[its.rows]->width;
    }
    things_.push_back(its);
  } while (++i < from.things_.size() && from.things_[i].parent >= thing);
  const Thing& last = from.things_[i - 1];
  names_.append(from.names_, names, last.name_at + last.name_size - names);
  return made;
}

std::uint32_t PresetShape::first_number(std::uint32_t thing) const {
  while (thing < things_.size() && things_[thing].rows == kNoRows) thing++;
  return thing < things_.size() ? things_[thing].at : width_;
}

std::uint32_t PresetShape::add_class(std::shared_ptr<const PresetClass> rows) {
  classes_.push_back(std::move(rows));
  return static_cast<std::uint32_t>(classes_.size() - 1);
}

std::uint32_t PresetBuilder::thing(std::string_view path) {
  while (!path.empty() && path.back() == '/') path.remove_suffix(1);
  if (path.empty()) return 0;
  const std::size_t slash = path.find_last_of('/');
  const std::uint32_t parent = slash == path.npos ? 0 : thing(path.substr(0, slash));
  // one thing, however its name is escaped
  const std::string name = unescape_name(path.substr(slash + 1));
  const auto [known, fresh] = things_.try_emplace(fmt::format("{}/{}", parent, name), 0);
  if (fresh) known->second = shape_->add(parent, name);
  return known->second;
}

void PresetBuilder::give(std::uint32_t thing, PresetClass rows, const std::vector<double>& values) {
  std::string key;
  for (const PresetRow& row : rows.rows) {
    key += fmt::format("{}\n{} {} {}\n", row.name, static_cast<int>(row.type), row.width, row.labels.size());
    for (const std::string& label : row.labels) key += fmt::format("{} {}\n", label.size(), label);
  }
  const auto [known, fresh] = classes_.try_emplace(std::move(key), 0);
  if (fresh) known->second = shape_->add_class(std::make_shared<const PresetClass>(std::move(rows)));
  shape_->give(thing, known->second);
  values_.insert(values_.end(), values.begin(), values.end());
}

std::shared_ptr<const Preset> PresetBuilder::finish(std::string name, PresetChoice choice) {
  return std::make_shared<const Preset>(
      Preset{std::move(name), std::move(choice), std::move(shape_), std::move(values_)});
}

namespace {

// a thing of a shape by where it stands
struct Spot {
  std::uint32_t parent;
  std::string_view name;
  bool operator==(const Spot&) const = default;
};
struct SpotHash {
  std::size_t operator()(const Spot& spot) const {
    return std::hash<std::string_view>{}(spot.name) ^ (spot.parent * 0x9e3779b97f4a7c15u);
  }
};

// two presets cut down to what both have
class Aligning {
 public:
  Aligning(const Preset& a, const Preset& b) : a_(a), b_(b) {}

  Blend run() {
    const PresetShape& from = *a_.shape;
    const PresetShape& to = *b_.shape;
    for (std::uint32_t i = 1; i < to.things().size(); i++)
      spots_.emplace(Spot{to.things()[i].parent, to.name(to.things()[i])}, i);
    std::vector<std::uint32_t> theirs(from.things().size(), 0);
    std::vector<std::uint32_t> made(from.things().size(), 0);
    for (std::uint32_t i = 0; i < from.things().size(); i++) {
      const PresetShape::Thing& thing = from.things()[i];
      if (i != 0) {
        if (thing.parent != 0 && theirs[thing.parent] == 0) continue;
        const auto spot = spots_.find(Spot{theirs[thing.parent], from.name(thing)});
        if (spot == spots_.end()) continue;
        theirs[i] = spot->second;
        made[i] = shape_->add(made[thing.parent], from.name(thing));
      }
      const PresetShape::Thing& other = to.things()[theirs[i]];
      if (from.rows(thing) != nullptr && to.rows(other) != nullptr) give(made[i], thing, other);
    }
    const auto first = std::make_shared<const Preset>(Preset{a_.name, a_.choice, shape_, std::move(in_a_)});
    return {first, std::make_shared<const Preset>(Preset{b_.name, b_.choice, shape_, std::move(in_b_)}), 0};
  }

 private:
  struct Common {  // of two classes
    struct Part {
      std::uint32_t a = 0;
      std::uint32_t b = 0;
      std::uint32_t width = 0;
      std::vector<double> labels;  // the second's in terms of both
    };
    std::uint32_t rows = PresetShape::kNoRows;
    std::vector<Part> parts;
  };

  void give(std::uint32_t made, const PresetShape::Thing& a, const PresetShape::Thing& b) {
    const Common& common = common_of(*a_.shape->rows(a), *b_.shape->rows(b));
    if (common.rows == PresetShape::kNoRows) return;
    shape_->give(made, common.rows);
    for (const Common::Part& part : common.parts) {
      const double* const in_a = a_.values.data() + a.at + part.a;
      const double* const in_b = b_.values.data() + b.at + part.b;
      in_a_.insert(in_a_.end(), in_a, in_a + part.width);
      in_b_.insert(in_b_.end(), in_b, in_b + part.width);
      if (!part.labels.empty()) in_b_.back() = part.labels[static_cast<std::size_t>(in_b[0])];
    }
  }

  const Common& common_of(const PresetClass& a, const PresetClass& b) {
    const auto [known, fresh] = commons_.try_emplace({&a, &b});
    Common& common = known->second;
    if (!fresh) return common;
    auto rows = std::make_shared<PresetClass>();
    for (std::size_t i = 0; i < a.rows.size(); i++) {
      const int at = b.find(a.rows[i].name);
      if (at < 0) continue;
      const PresetRow& theirs = b.rows[static_cast<std::size_t>(at)];
      PresetRow row = a.rows[i];
      if (theirs.type != row.type || theirs.width != row.width) continue;
      Common::Part part{a.offsets[i], b.offsets[static_cast<std::size_t>(at)], row.width, {}};
      for (const std::string& label : theirs.labels) {
        auto known_label = std::find(row.labels.begin(), row.labels.end(), label);
        if (known_label == row.labels.end()) known_label = row.labels.insert(row.labels.end(), label);
        part.labels.push_back(static_cast<double>(known_label - row.labels.begin()));
      }
      common.parts.push_back(std::move(part));
      rows->add(std::move(row));
    }
    if (!rows->rows.empty()) common.rows = shape_->add_class(std::move(rows));
    return common;
  }

  const Preset& a_;
  const Preset& b_;
  std::shared_ptr<PresetShape> shape_ = std::make_shared<PresetShape>();
  std::unordered_map<Spot, std::uint32_t, SpotHash> spots_;  // of b
  std::map<std::pair<const PresetClass*, const PresetClass*>, Common> commons_;
  std::vector<double> in_a_, in_b_;
};

}  // namespace

Blend aligned(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b) {
  if (a->shape == b->shape) return {a, b, 0};
  if (*a->shape == *b->shape)
    return {a, std::make_shared<const Preset>(Preset{b->name, b->choice, a->shape, b->values}), 0};
  return Aligning(*a, *b).run();
}

}  // namespace limber
