// Lookup of nodes and properties by name.
#include "engine/presets/binding.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/plural.h"
#include "base/text.h"
#include "properties/catalog.h"

namespace limber::engine {

namespace {

bool same_type(const PresetProperty& property, const Property& target) {
  if (property.type == PropertyType::number)
    return target.type == PropertyType::number || target.type == PropertyType::integer;
  return property.type == target.type && property.width == target.width;
}

// Joins names: "a, b, c …"; `count` is the total number.
std::string join_some(const std::vector<std::string>& names, std::size_t count) {
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  return count > names.size() ? text + " …" : text;
}

constexpr std::size_t kMaxNamed = 3;

bool is_group(const Store& store, NodeId id) { return store.table(id).name() == "group" && !store.is_group(id); }

}  // namespace

class PresetBinding::Builder {
 public:
  Builder(const Store& store, PresetBinding& binding) : store_(store), binding_(binding) {}

  Result<void> run(bool of_everything) {
    if (const Result<void> collected = collect_exclusions(); !collected) return collected;
    const PresetSchema& schema = *binding_.schema_;
    std::vector<NodeId> ids(schema.nodes().size());
    ids[0] = store_.root();
    for (std::uint32_t i = 0; i < schema.nodes().size(); i++) {
      const PresetSchema::Node& node = schema.nodes()[i];
      if (i != 0 && !ids[node.parent].null()) ids[i] = store_.child(ids[node.parent], schema.name(node));
      if (schema.layout(node) == nullptr) continue;
      if (ids[i].null()) {
        add_name(missing_, missing_count_, [&] { return schema.path(i); });
      } else {
        bind(ids[i], i);
      }
    }
    std::stable_partition(binding_.nodes_.begin(), binding_.nodes_.end(),
                          [&](const Node& node) { return is_group(store_, node.id); });
    describe_omissions(of_everything);
    return {};
  }

 private:
  template <class F>
  static void add_name(std::vector<std::string>& names, std::size_t& count, F&& name) {
    if (count++ < kMaxNamed) names.push_back(name());
  }

  Result<void> collect_exclusions() {
    for (const std::string& pattern : binding_.except_) {
      PatternBudget budget;
      const Result<std::vector<PropertyRef>> refs = match_properties(store_, pattern, budget);
      if (!refs && (is_pattern(pattern) || pattern.find("//") != std::string::npos))
        return Error{fmt::format("except: {}", refs.error())};
      if (!refs) continue;  // the node doesn't exist, so there is nothing to exclude
      for (const PropertyRef& ref : *refs) {
        if (ref.property == nullptr) {
          store_.walk(ref.node, [&](NodeId id) { excluded_[id.slot] = ~std::uint64_t{0}; });
        } else {
          excluded_[ref.node.slot] |= std::uint64_t{1} << ref.property->index;
        }
      }
    }
    return {};
  }

  void bind(NodeId id, std::uint32_t index) {
    const PresetSchema::Node& node = binding_.schema_->nodes()[index];
    const PropertyTable& table = store_.table(id);
    const std::uint32_t layout = layout_index(*binding_.schema_->layout(node), table);
    const LayoutBinding& binding = binding_.layouts_[layout];
    if (binding.mismatches > 0) {
      add_name(mismatches_, mismatch_count_,
               [&] { return binding_.schema_->path(index) + "/" + binding.first_mismatch; });
      mismatch_count_ += binding.mismatches - 1;
    }
    const auto found = excluded_.find(id.slot);
    const std::uint64_t excluded = found == excluded_.end() ? 0 : found->second;
    binding_.nodes_.push_back({id, index, layout, node.offset, excluded});
  }

  std::uint32_t layout_index(const PresetLayout& source, const PropertyTable& table) {
    const auto [entry, inserted] =
        layout_indices_.try_emplace({&source, &table}, static_cast<std::uint32_t>(binding_.layouts_.size()));
    if (!inserted) return entry->second;
    LayoutBinding layout{&source, &table, {}, {}, {}, 0};
    for (std::size_t i = 0; i < source.properties.size(); i++) {
      const PresetProperty& property = source.properties[i];
      const Property* const target = table.find(property.name);
      if (target == nullptr || !target->writable() || !target->stored() || !same_type(property, *target)) {
        if (layout.mismatches++ == 0) layout.first_mismatch = property.name;
        continue;
      }
      BoundProperty& bound = layout.properties.emplace_back(BoundProperty{target, &property, source.offsets[i], {}});
      for (const std::string& label : property.labels) {
        const auto at = std::find_if(target->choices.begin(), target->choices.end(),
                                     [&](const std::string& choice) { return same_name(choice, label); });
        bound.choice_map.push_back(at == target->choices.end() ? -1
                                                               : static_cast<double>(at - target->choices.begin()));
      }
      if (std::ranges::find(bound.choice_map, -1) != bound.choice_map.end())
        layout.incomplete_choices.push_back(static_cast<std::uint32_t>(layout.properties.size() - 1));
    }
    binding_.layouts_.push_back(std::move(layout));
    return entry->second;
  }

  // Returns the number of properties of the world that a preset of all properties lacks.
  std::size_t count_added() {
    std::unordered_map<const PropertyTable*, std::size_t> counts;
    std::size_t all = 0;
    std::size_t read_only = 0;
    store_.walk(store_.root(), [&](NodeId id) {
      const PropertyTable& table = store_.table(id);
      const auto [entry, inserted] = counts.try_emplace(&table, 0);
      if (inserted) {
        entry->second =
            static_cast<std::size_t>(std::ranges::count_if(table.properties(), [](const Property& property) {
              return property.kind == PropertyKind::setting && property.stored();
            }));
      }
      all += entry->second;
      for (const Property& property : table.properties()) {
        if (property.kind == PropertyKind::setting && property.validate != nullptr)
          read_only += property.validate(store_.object(id), store_.values(id, property)) ? 0 : 1;
      }
    });
    std::size_t properties = 0;
    for (const Node& node : binding_.nodes_) {
      for (const BoundProperty& property : binding_.layouts_[node.layout].properties)
        properties += property.property->kind == PropertyKind::setting ? 1 : 0;
    }
    all -= std::min(all, read_only);
    return all - std::min(all, properties);
  }

  void describe_omissions(bool of_everything) {
    std::vector<std::string> texts;
    if (missing_count_ > 0)
      texts.push_back(fmt::format("{} not found ({})", counted(missing_count_, "object was", "objects were"),
                                  join_some(missing_, missing_count_)));
    if (mismatch_count_ > 0)
      texts.push_back(fmt::format("{} missing or of another type ({})",
                                  counted(mismatch_count_, "property is", "properties are"),
                                  join_some(mismatches_, mismatch_count_)));
    const std::size_t added = of_everything ? count_added() : 0;
    if (added > 0)
      texts.push_back(fmt::format("{} new and {} unchanged", counted(added, "value is", "values are"),
                                  plural(added, "stays", "stay")));
    binding_.omissions_ = fmt::format("{}", fmt::join(texts, "; "));
  }

  const Store& store_;
  PresetBinding& binding_;
  std::unordered_map<std::uint32_t, std::uint64_t> excluded_;  // by slot
  std::map<std::pair<const PresetLayout*, const PropertyTable*>, std::uint32_t> layout_indices_;
  std::vector<std::string> missing_, mismatches_;
  std::size_t missing_count_ = 0;
  std::size_t mismatch_count_ = 0;
};

Result<std::shared_ptr<const PresetBinding>> PresetBinding::make(const Store& store,
                                                                 std::shared_ptr<const PresetSchema> schema,
                                                                 std::span<const std::string> except,
                                                                 bool of_everything) {
  auto binding = std::make_shared<PresetBinding>();
  binding->structure_version_ = store.structure_version();
  binding->schema_ = std::move(schema);
  binding->except_.assign(except.begin(), except.end());
  if (const Result<void> made = Builder(store, *binding).run(of_everything); !made) return Error{made.error()};
  return std::shared_ptr<const PresetBinding>(std::move(binding));
}

bool PresetBinding::read(const BoundProperty& property, const double* values, double* out) {
  const double* const from = values + property.offset;
  if (property.property->type != PropertyType::choice) {
    std::copy_n(from, property.property->width, out);
    return true;
  }
  out[0] = property.choice_map[static_cast<std::size_t>(from[0])];
  return out[0] >= 0;
}

namespace {

// Returns the label of the preset's value if the property has no such choice, else null.
const std::string* missing_label(const PresetBinding::BoundProperty& property, const double* values) {
  const auto label = static_cast<std::size_t>(values[property.offset]);
  return property.choice_map[label] < 0 ? &property.source->labels[label] : nullptr;
}

}  // namespace

std::string missing_choices(const Store& store, const PresetBinding& binding, const Blend& blend) {
  std::size_t count = 0;
  std::string first;
  for (const PresetBinding::Node& node : binding.nodes()) {
    for (const std::uint32_t i : binding.layout(node).incomplete_choices) {
      const PresetBinding::BoundProperty& property = binding.layout(node).properties[i];
      if ((node.excluded >> property.property->index & 1u) != 0) continue;
      const std::string* label = missing_label(property, blend.a->values.data() + node.offset);
      if (label == nullptr && blend.amount > 0) label = missing_label(property, blend.b->values.data() + node.offset);
      if (label == nullptr || count++ > 0) continue;
      first = fmt::format("{}/{} has no '{}' any more", store.path(node.id), property.property->name,
                          printable(shortened(*label, 100)));
    }
  }
  if (count == 0) return {};
  return fmt::format("{} unchanged ({})", counted(count, "choice stays", "choices stay"), first);
}

RecallResult recall(Store& store, const PresetBinding& binding, const Blend& blend) {
  RecallResult result;
  for_each_value(binding, blend, [&](const PresetBinding::Node& node, const Property& property, const double* values) {
    if (same_bits(values, store.values(node.id, property), property.width)) return;
    const Result<SetOutcome> set = store.set(node.id, property, {values, property.width});
    if (set && !set->clamped) return;
    if (result.clamped + result.rejected == 0) {
      result.first_problem =
          set ? fmt::format("{}/{} accepts {}", store.path(node.id), property.name, range_text(property)) : set.error();
    }
    (set ? result.clamped : result.rejected)++;
  });
  return result;
}

}  // namespace limber::engine
